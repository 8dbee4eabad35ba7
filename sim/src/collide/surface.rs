//! Contacts between a mesh and a convex shape: triangle by triangle, those that lie in one plane gathered into one
//! region.

use crate::collide::convex::Core;
use crate::collide::gjk::CorePair;
use crate::collide::mesh::{Mesh, Triangle};
use crate::collide::polytope::Polytope;
use crate::collide::region::{Region, RegionPoint};
use crate::collide::relative::Relative;
use crate::collide::sat::{Axis, SatBuffers};
use crate::collide::touch::TouchBuffers;
use crate::math::Vec3;
use crate::shape::{Aabb, Collider};

/// Cosine of the angle between two normals below which their points make one region.
const ONE_PLANE: f64 = 1.0 - 1e-6;
/// Share of the shape's inner radius within which two points are one.
const SAME_POINT: f64 = 1e-3;

/// Buffers of the query.
#[derive(Clone, Debug)]
pub(crate) struct SurfaceBuffers {
    near: Vec<u32>,
    triangle: Polytope,
    region: Region,
    /// Normals of the planes found, from the mesh outward.
    pub(crate) normals: Vec<Vec3>,
    /// Points with the plane each belongs to.
    points: Vec<(usize, RegionPoint)>,
}

impl Default for SurfaceBuffers {
    fn default() -> Self {
        Self {
            near: Vec::new(),
            triangle: Polytope::sheet(),
            region: Region::default(),
            normals: Vec::new(),
            points: Vec::new(),
        }
    }
}

impl SurfaceBuffers {
    /// Finds everything of `mesh` nearer than `reach` to the convex `shape`, which lies at `relative` as seen from the
    /// mesh. `gap` is a length small against the shape, `tolerance` one that tells axes apart.
    pub(crate) fn find(
        &mut self,
        mesh: &Mesh,
        shape: &Collider,
        relative: &Relative,
        reach: f64,
        (gap, tolerance): (f64, f64),
        (sat, touch): (&mut SatBuffers, &mut TouchBuffers),
    ) {
        self.normals.clear();
        self.points.clear();
        let Some((core, radius)) = shape.geometry.core() else { return };
        let bounds: Aabb = shape.bounds_at(relative).grown(reach);
        let center = (bounds.min + bounds.max) * 0.5;
        mesh.near(&bounds, &mut self.near);
        for at in 0..self.near.len() {
            let index = self.near[at];
            let triangle = &mesh.triangles[index as usize];
            let height = triangle.height(&center);
            // From behind a surface is open; and above the shape's reach nothing can touch.
            let extent = (bounds.max - bounds.min).dot(&triangle.normal.abs()) * 0.5;
            if height < 0.0 || height > extent {
                continue;
            }
            self.triangle.set_sheet(&triangle.corners, &triangle.normal);
            let (sheet, region) = (&self.triangle, &mut self.region);
            match core {
                Core::Polytope(polytope) => {
                    on_polytope(triangle, sheet, polytope, relative, reach, tolerance, sat, region);
                }
                _ => {
                    let pair = CorePair { a: Core::Polytope(sheet), b: core, relative: *relative };
                    touch.region(&pair, [0.0, radius], &triangle.normal, gap, reach, region);
                    if !triangle.owns(&region.normal) {
                        touch.region_along(&pair, [0.0, radius], &triangle.normal, reach, region);
                    }
                }
            }
            self.gather(index, SAME_POINT * shape.inner_radius);
        }
    }

    /// Puts the region's points to those of the same plane.
    fn gather(&mut self, triangle: u32, same: f64) {
        let Self { region, normals, points, .. } = self;
        if region.points.is_empty() {
            return;
        }
        let plane =
            normals.iter().position(|normal| normal.dot(&region.normal) > ONE_PLANE).unwrap_or_else(|| {
                normals.push(region.normal);
                normals.len() - 1
            });
        for point in &region.points {
            let known = points
                .iter_mut()
                .find(|(of, known)| *of == plane && (known.on_a - point.on_a).norm_squared() < same * same);
            match known {
                Some((_, known)) => known.separation = known.separation.min(point.separation),
                None => {
                    let feature = point.feature ^ u64::from(triangle) << 20;
                    points.push((plane, RegionPoint { feature, ..*point }));
                }
            }
        }
    }

    /// Whether the last search found no triangle near enough to be looked at.
    pub(crate) fn is_far(&self) -> bool {
        self.near.is_empty()
    }

    /// The region of plane `plane`.
    pub(crate) fn region(&self, plane: usize, out: &mut Region) {
        out.normal = self.normals[plane];
        out.points.clear();
        out.points.extend(self.points.iter().filter(|(of, _)| *of == plane).map(|(_, point)| *point));
    }
}

#[expect(clippy::too_many_arguments, reason = "one call, and a struct for it would say nothing more")]
fn on_polytope(
    triangle: &Triangle,
    sheet: &Polytope,
    polytope: &Polytope,
    relative: &Relative,
    reach: f64,
    tolerance: f64,
    sat: &mut SatBuffers,
    region: &mut Region,
) {
    region.points.clear();
    let front = Axis::FaceOfA(0);
    let found = sat.separation((sheet, polytope), relative, (reach, f64::INFINITY), tolerance, Some(front));
    if found.distance >= reach {
        return;
    }
    let axis =
        if found.axis != Axis::FaceOfA(1) && triangle.owns(&found.normal) { found.axis } else { front };
    sat.region((sheet, polytope), relative, axis, reach, axis != front, region);
}
