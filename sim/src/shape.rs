//! A collision shape with what the narrow phase asks of it, computed once.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::collide::convex::Core;
use crate::collide::mesh::Mesh;
use crate::collide::polytope::Polytope;
use crate::collide::relative::Relative;
use crate::error::SceneError;
use crate::material::MaterialPair;
use crate::math::{Frame3, Vec3};
use crate::scene::{ChildShape, Pose, Shape as SceneShape, Surface};

/// What a shape is, for the narrow phase.
#[derive(Clone, Debug)]
pub(crate) enum Geometry {
    Sphere {
        radius: f64,
    },
    Capsule {
        half_height: f64,
        radius: f64,
    },
    Cylinder {
        half_height: f64,
        radius: f64,
    },
    Cone {
        half_height: f64,
        radius: f64,
    },
    /// A box or a hull. Shared between the copies of a world.
    Polytope(Arc<Polytope>),
    HalfSpace,
    Mesh(Arc<Mesh>),
}

impl Geometry {
    pub(crate) fn mesh(&self) -> Option<&Mesh> {
        if let Self::Mesh(mesh) = self { Some(mesh) } else { None }
    }

    /// Core and radius of a convex shape; `None` for a half-space or a mesh.
    pub(crate) fn core(&self) -> Option<(Core<'_>, f64)> {
        Some(match self {
            Self::Sphere { radius } => (Core::Point, *radius),
            Self::Capsule { half_height, radius } => (Core::Segment { half_height: *half_height }, *radius),
            Self::Cylinder { half_height, radius } => {
                (Core::Cylinder { half_height: *half_height, radius: *radius }, 0.0)
            }
            Self::Cone { half_height, radius } => {
                (Core::Cone { half_height: *half_height, radius: *radius }, 0.0)
            }
            Self::Polytope(polytope) => (Core::Polytope(polytope), 0.0),
            Self::HalfSpace | Self::Mesh(_) => return None,
        })
    }
}

/// m from the origin at which bounds end that have no end.
const FAR: f64 = 1e9;

/// One shape of a body.
#[derive(Clone)]
pub(crate) struct Collider {
    pub(crate) geometry: Geometry,
    pub(crate) surface: Surface,
    /// Those of the scene's pairs that this material belongs to.
    pub(crate) pairs: Vec<MaterialPair>,
    /// Half the smallest extent of the bounding box, m: what a tolerance may be a share of.
    pub(crate) inner_radius: f64,
    /// Largest distance of a point from the body's origin, m.
    pub(crate) reach: f64,
    /// Largest distance of a point from the shape's own origin, m.
    pub(crate) shape_reach: f64,
    half_extents: Vec3,
    center: Vec3,
    /// Of the shape in its body; `None` where the frames are the same.
    placement: Option<Relative>,
    /// Where the shape is in the world, and its bounds there, as of the step's start.
    pub(crate) world: Relative,
    pub(crate) bounds: Aabb,
}

/// An axis-aligned box in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Aabb {
    pub(crate) min: Vec3,
    pub(crate) max: Vec3,
}

impl Aabb {
    pub(crate) fn grown(self, margin: f64) -> Self {
        Self { min: self.min.add_scalar(-margin), max: self.max.add_scalar(margin) }
    }

    pub(crate) fn shifted(self, by: &Vec3) -> Self {
        Self { min: self.min + by, max: self.max + by }
    }

    pub(crate) fn contains(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.min[axis] <= other.min[axis] && other.max[axis] <= self.max[axis])
    }

    /// How far apart two boxes are along the axis that parts them most, m; negative where they overlap.
    pub(crate) fn gap(&self, other: &Self) -> f64 {
        (0..3)
            .map(|axis| (self.min[axis] - other.max[axis]).max(other.min[axis] - self.max[axis]))
            .fold(f64::NEG_INFINITY, f64::max)
    }

    pub(crate) fn merged(self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.min[axis] <= other.max[axis] && other.min[axis] <= self.max[axis])
    }
}

impl Collider {
    /// # Errors
    /// [`SceneError::Shape`], [`SceneError::StaticOnly`] or [`SceneError::Surface`], naming entity and shape.
    pub(crate) fn new(
        child: &ChildShape,
        entity: &str,
        index: usize,
        is_static: bool,
    ) -> Result<Self, SceneError> {
        let fault = |fault: String| SceneError::Shape { entity: entity.to_owned(), shape: index, fault };
        let static_only = |kind| SceneError::StaticOnly { entity: entity.to_owned(), shape: index, kind };
        let positive = |what: &str, value: f64| {
            if value > 0.0 && value.is_finite() {
                Ok(value)
            } else {
                Err(fault(format!("{what} is {value} m; expected a finite number above 0")))
            }
        };
        check_surface(&child.surface, entity, index)?;
        let (geometry, min, max) = match &child.shape {
            SceneShape::Sphere { radius } => {
                let radius = positive("radius", *radius)?;
                (Geometry::Sphere { radius }, Vec3::repeat(-radius), Vec3::repeat(radius))
            }
            SceneShape::Box { half_extents } => {
                for half in half_extents {
                    positive("a half extent", *half)?;
                }
                let half = Vec3::from(*half_extents);
                (Geometry::Polytope(Arc::new(Polytope::cuboid(&half))), -half, half)
            }
            SceneShape::Capsule { half_height, radius } => {
                let (half_height, radius) =
                    (positive("half height", *half_height)?, positive("radius", *radius)?);
                let half = Vec3::new(radius, half_height + radius, radius);
                (Geometry::Capsule { half_height, radius }, -half, half)
            }
            SceneShape::Cylinder { half_height, radius } => {
                let (half_height, radius) =
                    (positive("half height", *half_height)?, positive("radius", *radius)?);
                let half = Vec3::new(radius, half_height, radius);
                (Geometry::Cylinder { half_height, radius }, -half, half)
            }
            SceneShape::Cone { half_height, radius } => {
                let (half_height, radius) =
                    (positive("half height", *half_height)?, positive("radius", *radius)?);
                let half = Vec3::new(radius, half_height, radius);
                (Geometry::Cone { half_height, radius }, -half, half)
            }
            SceneShape::Hull { points } => {
                let corners: Vec<Vec3> = points.iter().map(|point| Vec3::from(*point)).collect();
                if corners.iter().any(|corner| !corner.iter().all(|x| x.is_finite())) {
                    return Err(fault("a hull point is not finite".to_owned()));
                }
                let hull = Polytope::hull(&corners).map_err(fault)?;
                let (min, max) = bounds(&hull.vertices)
                    .ok_or_else(|| fault("a hull of no points; expected four or more".to_owned()))?;
                (Geometry::Polytope(Arc::new(hull)), min, max)
            }
            SceneShape::HalfSpace if is_static => {
                (Geometry::HalfSpace, Vec3::repeat(-FAR), Vec3::new(FAR, 0.0, FAR))
            }
            SceneShape::HalfSpace => return Err(static_only("half-space")),
            SceneShape::TriangleMesh { positions, triangles } if is_static => {
                surface(positions, triangles).map_err(fault)?
            }
            SceneShape::TriangleMesh { .. } => return Err(static_only("triangle mesh")),
            SceneShape::HeightField(field) if is_static => {
                if let Some(wrong) = field.fault() {
                    return Err(fault(wrong));
                }
                let (positions, triangles) = field.mesh();
                surface(&positions, &triangles).map_err(fault)?
            }
            SceneShape::HeightField(_) => return Err(static_only("height field")),
        };
        let half_extents = (max - min) * 0.5;
        let center = (max + min) * 0.5;
        let body_from_shape = Frame3::from(&child.body_from_shape);
        // A surface has no inside: its size as a whole is hardly ever the smaller of two.
        let inner_radius = if geometry.mesh().is_some() { half_extents.norm() } else { half_extents.min() };
        Ok(Self {
            geometry,
            surface: child.surface,
            pairs: Vec::new(),
            inner_radius,
            reach: body_from_shape.position.norm() + center.norm() + half_extents.norm(),
            shape_reach: center.norm() + half_extents.norm(),
            half_extents,
            center,
            placement: (body_from_shape != Frame3::from(&Pose::IDENTITY)).then(|| (&body_from_shape).into()),
            world: (&body_from_shape).into(),
            bounds: Aabb { min, max },
        })
    }

    /// Keeps what the scene's pairs say of this material.
    pub(crate) fn learn(&mut self, pairs: &[MaterialPair]) {
        let own = pairs
            .iter()
            .filter(|pair| self.surface.material.is_some_and(|material| pair.between.contains(&material)));
        self.pairs = own.copied().collect();
    }

    /// Puts the shape where its body is, and returns its bounds.
    pub(crate) fn place(&mut self, body: &Relative) -> Aabb {
        self.world = self.in_world(body);
        self.bounds = self.bounds_at(&self.world);
        self.bounds
    }

    /// Where the shape is when its body is at `body`.
    pub(crate) fn in_world(&self, body: &Relative) -> Relative {
        self.placement.as_ref().map_or(*body, |placement| body.compose(placement))
    }

    /// Bounds of the shape where it lies at `relative`: exact, but for a mesh those of its box. Round ones have a disc's
    /// reach of radius times the sine between its axis and the axis of the bounds.
    pub(crate) fn bounds_at(&self, relative: &Relative) -> Aabb {
        let axis = || relative.rotation.column(1).into_owned();
        let disc = |radius: f64| axis().map(|y| radius * (1.0 - y * y).max(0.0).sqrt());
        let about = |half: Vec3| {
            let center = relative.point(&self.center);
            Aabb { min: center - half, max: center + half }
        };
        match &self.geometry {
            Geometry::HalfSpace => {
                let mut bounds = Aabb { min: Vec3::repeat(-FAR), max: Vec3::repeat(FAR) };
                // Level ground has a top, so that what is high above it is no pair.
                let up = axis();
                if let Some(level) = (0..3).find(|level| up[*level] == 1.0) {
                    bounds.max[level] = relative.translation[level];
                }
                bounds
            }
            Geometry::Sphere { radius } => about(Vec3::repeat(*radius)),
            Geometry::Capsule { half_height, radius } => {
                about(axis().abs().scale(*half_height).add_scalar(*radius))
            }
            Geometry::Cylinder { half_height, radius } => about(axis().abs() * *half_height + disc(*radius)),
            Geometry::Cone { half_height, radius } => {
                let (tip, disc) = (axis() * *half_height, disc(*radius));
                let (low, high) = (tip.inf(&(-tip - disc)), tip.sup(&(disc - tip)));
                Aabb { min: relative.translation + low, max: relative.translation + high }
            }
            Geometry::Polytope(hull) if hull.half_extents.is_none() => hull.bounds_at(relative),
            Geometry::Polytope(_) | Geometry::Mesh(_) => about(relative.rotation.abs() * self.half_extents),
        }
    }

    /// A point of the shape in the frame of its body.
    pub(crate) fn in_body(&self, point: &Vec3) -> Vec3 {
        self.placement.as_ref().map_or(*point, |placement| placement.point(point))
    }
}

/// Makes equal boxes and hulls one in memory: a heap of a few kinds then fits into the cache.
pub(crate) fn share<'a>(colliders: impl Iterator<Item = &'a mut Collider>) {
    let mut known: BTreeMap<Vec<[u64; 3]>, Arc<Polytope>> = BTreeMap::new();
    for collider in colliders {
        if let Geometry::Polytope(polytope) = &mut collider.geometry {
            let bits = polytope.vertices.iter().map(|v| [v.x, v.y, v.z].map(f64::to_bits)).collect();
            *polytope = Arc::clone(known.entry(bits).or_insert_with(|| Arc::clone(polytope)));
        }
    }
}

fn surface(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<(Geometry, Vec3, Vec3), String> {
    let mesh = Mesh::new(positions, triangles)?;
    let corners = mesh.triangles.iter().flat_map(|triangle| triangle.corners);
    let empty = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    let (min, max) = corners.fold(empty, |(min, max), corner| (min.inf(&corner), max.sup(&corner)));
    Ok((Geometry::Mesh(Arc::new(mesh)), min, max))
}

fn bounds(points: &[Vec3]) -> Option<(Vec3, Vec3)> {
    let first = points.first()?;
    Some(points.iter().fold((*first, *first), |(min, max), point| (min.inf(point), max.sup(point))))
}

fn check_surface(surface: &Surface, entity: &str, shape: usize) -> Result<(), SceneError> {
    let wrong = |what, value, range| {
        Err(SceneError::Surface { entity: entity.to_owned(), shape, what, value, range })
    };
    if !(surface.friction >= 0.0 && surface.friction.is_finite()) {
        return wrong("friction", surface.friction, "0 or more");
    }
    if !(0.0..=1.0).contains(&surface.restitution) {
        return wrong("restitution", surface.restitution, "0 to 1");
    }
    if !(surface.rolling_resistance >= 0.0 && surface.rolling_resistance.is_finite()) {
        return wrong("rolling resistance", surface.rolling_resistance, "0 or more");
    }
    Ok(())
}
