//! The axis along which two polytopes are farthest apart, or overlap least: the faces of both and the edge pairs that
//! make a face of their Minkowski difference (Gregorius 2013, "The Separating Axis Test between Convex Polyhedra").
//!
//! Faces are weighed eight at a time in f32, which only decides between axes; what comes out is computed in f64.

use crate::collide::boxes;
use crate::collide::polytope::{Polytope, Vec3x8};
use crate::collide::region::{ClipBuffers, Region, RegionPoint, nearest_on_lines};
use crate::math::{Frame3, Mat3, Vec3};

/// Where shape B lies, seen from the frame of shape A.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relative {
    pub(crate) rotation: Mat3,
    pub(crate) translation: Vec3,
}

impl From<&Frame3> for Relative {
    fn from(frame: &Frame3) -> Self {
        Self { rotation: *frame.rotation.to_rotation_matrix().matrix(), translation: frame.position }
    }
}

impl Relative {
    pub(crate) fn compose(&self, inner: &Self) -> Self {
        Self { rotation: self.rotation * inner.rotation, translation: self.point(&inner.translation) }
    }

    /// Where `other` lies, seen from here.
    pub(crate) fn inverse_compose(&self, other: &Self) -> Self {
        Self {
            rotation: self.rotation.tr_mul(&other.rotation),
            translation: self.rotation.tr_mul(&(other.translation - self.translation)),
        }
    }

    pub(crate) fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self { rotation, translation: -(rotation * self.translation) }
    }

    pub(crate) fn point(&self, b: &Vec3) -> Vec3 {
        self.rotation * b + self.translation
    }

    /// How far a point within `reach` of B's origin may have moved against A since `before`, at most, m.
    pub(crate) fn motion_since(&self, before: &Self, reach: f64) -> f64 {
        // |ΔR| <= its Frobenius norm over sqrt 2, with equality for a rotation about one axis.
        let turn = (self.rotation - before.rotation).norm() * std::f64::consts::FRAC_1_SQRT_2;
        (self.translation - before.translation).norm() + turn * reach
    }
}

/// What defines the normal of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    FaceOfA(u32),
    FaceOfB(u32),
    /// An edge of A and one of B.
    Edges(u32, u32),
}

/// The best axis of a pair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Separation {
    pub(crate) axis: Axis,
    /// Unit, from A to B, frame of A.
    pub(crate) normal: Vec3,
    /// m; negative where the shapes overlap.
    pub(crate) distance: f64,
    /// m by which every axis of another direction is worse, at least: half of it the shapes may move before
    /// another axis can be the best.
    pub(crate) lead: f64,
}

/// Buffers of a query.
#[derive(Clone, Debug, Default)]
pub(crate) struct SatBuffers {
    /// Vertices of B in the frame of A.
    vertices_b: Vec<Vec3>,
    points: Vec<[f32; 3]>,
    distances: Vec<f32>,
    edges_a: Vec<u32>,
    edges_b: Vec<u32>,
    pub(crate) clip: ClipBuffers,
}

/// Cosine above which two axes count as the same.
const SAME_DIRECTION: f64 = 0.9998;

#[expect(clippy::cast_possible_truncation, reason = "eight lanes of f32 decide between axes, no more")]
fn single(v: &Vec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

/// Signed distance of the nearest of `points` from every plane.
fn plane_distances(normals: &[Vec3x8], offsets: &[[f32; 8]], points: &[[f32; 3]], out: &mut Vec<f32>) {
    for (normal, offset) in normals.iter().zip(offsets) {
        let mut nearest = [f32::INFINITY; 8];
        for [x, y, z] in points {
            for (i, nearest) in nearest.iter_mut().enumerate() {
                let along = normal.x[i] * x + normal.y[i] * y + normal.z[i] * z;
                *nearest = if along < *nearest { along } else { *nearest };
            }
        }
        out.extend(nearest.iter().zip(offset).map(|(nearest, offset)| nearest - offset));
    }
}

/// Best and, where its direction differs from the best's, second best of the faces.
struct Best {
    index: usize,
    distance: f64,
}

fn best(distances: &[f32]) -> Best {
    let mut found = Best { index: 0, distance: f64::NEG_INFINITY };
    for (index, &distance) in distances.iter().enumerate() {
        if f64::from(distance) > found.distance {
            found = Best { index, distance: f64::from(distance) };
        }
    }
    found
}

impl SatBuffers {
    /// The axis of most separation. Axes nearer to each other than `tolerance` (m) count as equal: faces go before
    /// edges, and `previous` before all. Where the shapes are farther apart than `reach` along some axis, that one
    /// comes back without a look at the others.
    pub(crate) fn separation(
        &mut self,
        (a, b): (&Polytope, &Polytope),
        relative: &Relative,
        reach: f64,
        tolerance: f64,
        previous: Option<Axis>,
    ) -> Separation {
        let boxes = a.half_extents.zip(b.half_extents);
        self.distances.clear();
        if let Some((half_a, half_b)) = boxes {
            boxes::face_distances(&half_a, &half_b, relative, &mut self.distances);
        } else {
            self.place(b, relative);
            self.points.clear();
            self.points.extend(self.vertices_b.iter().map(single));
            plane_distances(&a.normals_x8, &a.offsets_x8, &self.points, &mut self.distances);
            self.distances.truncate(a.faces.len());
        }
        let on_a = best(&self.distances[..a.faces.len()]);
        if on_a.distance > reach {
            return Separation {
                axis: Axis::FaceOfA(index(on_a.index)),
                normal: a.faces[on_a.index].normal,
                distance: on_a.distance,
                lead: 0.0,
            };
        }
        if boxes.is_none() {
            // Faces of B against the vertices of A, in the frame of B, where the planes need no turning.
            self.points.clear();
            self.points.extend(
                a.vertices.iter().map(|v| single(&relative.rotation.tr_mul(&(v - relative.translation)))),
            );
            plane_distances(&b.normals_x8, &b.offsets_x8, &self.points, &mut self.distances);
            self.distances.truncate(a.faces.len() + b.faces.len());
        }
        let on_b = best(&self.distances[a.faces.len()..]);
        let normal_b = |face: usize| -(relative.rotation * b.faces[face].normal);
        if on_b.distance > reach {
            return Separation {
                axis: Axis::FaceOfB(index(on_b.index)),
                normal: normal_b(on_b.index),
                distance: on_b.distance,
                lead: 0.0,
            };
        }
        let mut chosen = if on_b.distance > on_a.distance + tolerance {
            (Axis::FaceOfB(index(on_b.index)), on_b.distance)
        } else {
            (Axis::FaceOfA(index(on_a.index)), on_a.distance)
        };
        let known = |axis: Axis| match axis {
            Axis::FaceOfA(face) => self.distances.get(face as usize).copied().map(f64::from),
            Axis::FaceOfB(face) => self.distances.get(a.faces.len() + face as usize).copied().map(f64::from),
            Axis::Edges(..) => None,
        };
        if let Some((axis, distance)) = previous.and_then(|axis| Some((axis, known(axis)?)))
            && distance > chosen.1 - tolerance
        {
            chosen = (axis, distance);
        }
        let edge = match &boxes {
            Some((half_a, half_b)) => boxes::best_edges((a, half_a), (b, half_b), relative),
            None => self.best_edges(a, b, relative, reach + (-chosen.1).max(0.0)),
        };
        let mut runner_up = f64::NEG_INFINITY;
        let mut result = Separation {
            axis: chosen.0,
            normal: match chosen.0 {
                Axis::FaceOfB(face) => normal_b(face as usize),
                Axis::FaceOfA(face) => a.faces[face as usize].normal,
                Axis::Edges(..) => Vec3::y(),
            },
            distance: chosen.1,
            lead: 0.0,
        };
        if let Some((axis, normal, distance)) = edge {
            let kept = previous == Some(axis) && distance > chosen.1 - tolerance;
            if kept || distance > chosen.1 + tolerance {
                result = Separation { axis, normal, distance, lead: 0.0 };
            } else {
                runner_up = distance;
            }
        }
        let (faces_a, faces_b) = self.distances.split_at(a.faces.len());
        for (face, &distance) in faces_a.iter().enumerate() {
            let distance = f64::from(distance);
            if distance > runner_up && a.faces[face].normal.dot(&result.normal) < SAME_DIRECTION {
                runner_up = distance;
            }
        }
        for (face, &distance) in faces_b.iter().enumerate() {
            let distance = f64::from(distance);
            if distance > runner_up && normal_b(face).dot(&result.normal) < SAME_DIRECTION {
                runner_up = distance;
            }
        }
        result.lead = (result.distance - runner_up).min(reach);
        result
    }

    fn place(&mut self, b: &Polytope, relative: &Relative) {
        self.vertices_b.clear();
        self.vertices_b.extend(b.vertices.iter().map(|v| relative.point(v)));
    }

    /// The best pair of edges that can matter: if the shapes overlap by d, two edges that define the least way out
    /// are nearer to each other than d, so both pass through the common part of the bounds grown by `within`.
    fn best_edges(
        &mut self,
        a: &Polytope,
        b: &Polytope,
        relative: &Relative,
        within: f64,
    ) -> Option<(Axis, Vec3, f64)> {
        let bounds = |points: &[Vec3]| {
            points.iter().fold((Vec3::repeat(f64::MAX), Vec3::repeat(f64::MIN)), |(low, high), p| {
                (low.inf(p), high.sup(p))
            })
        };
        let ((low_a, high_a), (low_b, high_b)) = (bounds(&a.vertices), bounds(&self.vertices_b));
        let (low, high) = (low_a.sup(&low_b).add_scalar(-within), high_a.inf(&high_b).add_scalar(within));
        let inside =
            |p: &Vec3, q: &Vec3| (0..3).all(|k| p[k].min(q[k]) <= high[k] && p[k].max(q[k]) >= low[k]);
        let Self { vertices_b, edges_a, edges_b, .. } = self;
        let crosses = |vertices: &[Vec3], tail: u32, head: u32| {
            inside(&vertices[tail as usize], &vertices[head as usize])
        };
        edges_a.clear();
        edges_a.extend(
            (0..).zip(&a.edges).filter(|(_, e)| crosses(&a.vertices, e.tail, e.head)).map(|(i, _)| i),
        );
        if edges_a.is_empty() {
            return None;
        }
        edges_b.clear();
        edges_b
            .extend((0..).zip(&b.edges).filter(|(_, e)| crosses(vertices_b, e.tail, e.head)).map(|(i, _)| i));

        let mut found: Option<(Axis, Vec3, f64)> = None;
        for &j in edges_b.iter() {
            let edge = &b.edges[j as usize];
            let tail_b = vertices_b[edge.tail as usize];
            let along_b = vertices_b[edge.head as usize] - tail_b;
            let left_b = relative.rotation * b.faces[edge.left as usize].normal;
            let right_b = relative.rotation * b.faces[edge.right as usize].normal;
            for &i in edges_a.iter() {
                let edge = &a.edges[i as usize];
                let (left_a, right_a) =
                    (&a.faces[edge.left as usize].normal, &a.faces[edge.right as usize].normal);
                let (u, v) = (left_a.dot(&along_b), right_a.dot(&along_b));
                if u * v >= 0.0 {
                    continue;
                }
                let tail_a = a.vertices[edge.tail as usize];
                let along_a = a.vertices[edge.head as usize] - tail_a;
                let (p, q) = (left_b.dot(&along_a), right_b.dot(&along_a));
                if p * q >= 0.0 {
                    continue;
                }
                let cross = along_a.cross(&along_b);
                let square = cross.norm_squared();
                if square <= 1e-8 * along_a.norm_squared() * along_b.norm_squared() {
                    continue;
                }
                // Outward of A is inward of B; of a sheet's edges B alone knows.
                let normal = cross * (-cross.dot(&(left_b + right_b)).signum() / square.sqrt());
                // The arcs of the two edges on the Gauss map cross.
                if normal.dot(&edge.outward(a)) <= 0.0 {
                    continue;
                }
                let distance = normal.dot(&(tail_b - tail_a));
                if found.is_none_or(|(.., best)| distance > best) {
                    found = Some((Axis::Edges(i, j), normal, distance));
                }
            }
        }
        found
    }

    /// A side of what stands still over which the other shape slides into the gap between `chosen` and it, where the
    /// last query chose an axis that would stop it: the seam between two tiles is no wall. `velocity` is that of B
    /// against A, and `lip` how high a step in the ground may be and still be none.
    pub(crate) fn sliding_axis(
        &self,
        (a, b): (&Polytope, &Polytope),
        relative: &Relative,
        chosen: &Vec3,
        (velocity, lip): (&Vec3, f64),
        stands: [bool; 2],
    ) -> Option<Axis> {
        const HEAD_ON: f64 = 0.5;
        const ALONG: f64 = 0.1;
        let speed = velocity.norm();
        if velocity.dot(chosen) > -HEAD_ON * speed {
            return None;
        }
        let (on_a, on_b) = self.distances.split_at(self.distances.len().min(a.faces.len()));
        let faces_a = (0..).zip(&a.faces).map(|(i, face)| (Axis::FaceOfA(i), face.normal));
        let faces_b =
            (0..).zip(&b.faces).map(|(i, face)| (Axis::FaceOfB(i), relative.rotation * face.normal));
        let of_a = faces_a.zip(on_a).filter(|_| stands[0]);
        let of_b = faces_b.zip(on_b).filter(|_| stands[1]);
        of_a.chain(of_b)
            .filter(|((_, normal), distance)| {
                f64::from(**distance).abs() < lip && velocity.dot(normal).abs() < ALONG * speed
            })
            .max_by(|(_, p), (_, q)| p.total_cmp(q))
            .map(|((axis, _), _)| axis)
    }

    /// The region that `axis` defines, points farther apart than `reach` left out. Its normal is computed anew, as
    /// the shapes may have moved since the axis was found. Where a face has nothing over it, the deepest corner
    /// stands in if `lone_corner`.
    pub(crate) fn region(
        &mut self,
        (a, b): (&Polytope, &Polytope),
        relative: &Relative,
        axis: Axis,
        reach: f64,
        lone_corner: bool,
        region: &mut Region,
    ) {
        region.points.clear();
        match axis {
            Axis::FaceOfA(face) => {
                let normal = a.faces[face as usize].normal;
                let incident = b.face_along(&-(relative.rotation.transpose() * normal));
                let clip = &mut self.clip;
                clip.set_reference(a.face_loop(face as usize).iter().map(|&v| a.vertices[v as usize]));
                let corners = b.face_loop(incident).iter();
                clip.set_incident(corners.map(|&v| (relative.point(&b.vertices[v as usize]), v)));
                let deepest =
                    || relative.point(&b.vertices[b.support(&-(relative.rotation.transpose() * normal))]);
                region.normal = normal;
                clip_faces(clip, region, &normal, true, reach, lone_corner.then_some(&deepest));
            }
            Axis::FaceOfB(face) => {
                let normal = relative.rotation * b.faces[face as usize].normal;
                let incident = a.face_along(&-normal);
                let clip = &mut self.clip;
                let corners = b.face_loop(face as usize).iter();
                clip.set_reference(corners.map(|&v| relative.point(&b.vertices[v as usize])));
                clip.set_incident(a.face_loop(incident).iter().map(|&v| (a.vertices[v as usize], v)));
                region.normal = -normal;
                let deepest = || a.vertices[a.support(&-normal)];
                clip_faces(clip, region, &normal, false, reach, lone_corner.then_some(&deepest));
            }
            Axis::Edges(i, j) => edge_point(a, b, relative, (i, j), reach, region),
        }
    }
}

/// Where clipping leaves nothing (the deepest corner lies over a side of the face), that corner alone.
fn clip_faces(
    clip: &mut ClipBuffers,
    region: &mut Region,
    normal: &Vec3,
    of_a: bool,
    reach: f64,
    deepest: Option<&dyn Fn() -> Vec3>,
) {
    clip.clip(normal);
    let origin = clip.reference.first().copied().unwrap_or_default();
    clip.push_points(region, (&origin, normal), of_a, reach);
    if let Some(deepest) = deepest.filter(|_| region.points.is_empty()) {
        let corner = deepest();
        let separation = (corner - origin).dot(normal);
        if separation < 0.0 {
            let on_a = if of_a { corner - normal * separation } else { corner };
            region.points.push(RegionPoint { on_a, separation, feature: u64::MAX });
        }
    }
}

fn edge_point(
    a: &Polytope,
    b: &Polytope,
    relative: &Relative,
    (i, j): (u32, u32),
    reach: f64,
    region: &mut Region,
) {
    let (edge_a, edge_b) = (&a.edges[i as usize], &b.edges[j as usize]);
    let tail_a = a.vertices[edge_a.tail as usize];
    let along_a = a.vertices[edge_a.head as usize] - tail_a;
    let tail_b = relative.point(&b.vertices[edge_b.tail as usize]);
    let along_b = relative.point(&b.vertices[edge_b.head as usize]) - tail_b;
    let cross = along_a.cross(&along_b);
    let Some((s, t)) = nearest_on_lines(&tail_a, &along_a, &tail_b, &along_b) else { return };
    let outward = edge_a.outward(a);
    region.normal = cross * (cross.dot(&outward).signum() / cross.norm());
    let on_a = tail_a + along_a * s.clamp(0.0, 1.0);
    let on_b = tail_b + along_b * t.clamp(0.0, 1.0);
    let separation = (on_b - on_a).dot(&region.normal);
    if separation < reach {
        let feature = 1 << 63 | u64::from(i) << 32 | u64::from(j);
        region.points.push(RegionPoint { on_a, separation, feature });
    }
}

fn index(i: usize) -> u32 {
    u32::try_from(i).unwrap_or(u32::MAX)
}
