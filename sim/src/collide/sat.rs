//! The axis along which two polytopes are farthest apart, or overlap least: the faces of both and the edge pairs that
//! make a face of their Minkowski difference (Gregorius 2013, "The Separating Axis Test between Convex Polyhedra").
//!
//! [`crate::collide::axes`] weighs them eight at a time in f32, which only decides between axes; what comes out is
//! computed in f64.

use crate::collide::axes::{AxisBuffers, Known};
use crate::collide::boxes;
use crate::collide::edges;
use crate::collide::polytope::Polytope;
use crate::collide::region::{ClipBuffers, Region, RegionPoint};
use crate::collide::relative::Relative;
use crate::math::Vec3;

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
    pub(crate) axes: AxisBuffers,
    pub(crate) clip: ClipBuffers,
}

/// Cosine above which two axes count as the same.
const SAME_DIRECTION: f64 = 0.9998;

/// The face of most distance; the first of equals.
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
    /// comes back without a look at the others. `most` is what no axis can part them by more than, if that is known: see
    /// [`most`].
    pub(crate) fn separation(
        &mut self,
        (a, b): (&Polytope, &Polytope),
        relative: &Relative,
        (reach, most): (f64, f64),
        tolerance: f64,
        previous: Option<Axis>,
    ) -> Separation {
        let boxes = a.half_extents.zip(b.half_extents);
        self.axes.distances.clear();
        if let Some((half_a, half_b)) = boxes {
            boxes::face_distances(&half_a, &half_b, relative, &mut self.axes.distances);
        } else {
            self.axes.weigh_faces(a, b, relative);
        }
        let on_a = best(&self.axes.distances[..a.faces.len()]);
        if on_a.distance > reach {
            return Separation {
                axis: Axis::FaceOfA(index(on_a.index)),
                normal: a.faces[on_a.index].normal,
                distance: on_a.distance,
                lead: 0.0,
            };
        }
        if boxes.is_none() {
            // In the frame of B, where its planes need no turning.
            self.axes.weigh_faces(b, a, &relative.inverse());
        }
        let on_b = best(&self.axes.distances[a.faces.len()..]);
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
            Axis::FaceOfA(face) => self.axes.distances.get(face as usize).copied().map(f64::from),
            Axis::FaceOfB(face) => {
                self.axes.distances.get(a.faces.len() + face as usize).copied().map(f64::from)
            }
            Axis::Edges(..) => None,
        };
        if let Some((axis, distance)) = previous.and_then(|axis| Some((axis, known(axis)?)))
            && distance > chosen.1 - tolerance
        {
            chosen = (axis, distance);
        }
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
        let edge = match &boxes {
            Some((half_a, half_b)) => boxes::best_edges((a, half_a), (b, half_b), relative),
            None => {
                let known = Known {
                    normal: &result.normal,
                    distance: result.distance,
                    reach: reach.min(most + tolerance),
                };
                let pair = self.axes.best_edges((a, b), relative, known);
                pair.and_then(|pair| edges::normal((a, b), relative, pair))
            }
        };
        if let Some((axis, normal, distance)) = edge {
            let kept = previous == Some(axis) && distance > chosen.1 - tolerance;
            if kept || distance > chosen.1 + tolerance {
                result = Separation { axis, normal, distance, lead: 0.0 };
            } else if normal.dot(&result.normal) < SAME_DIRECTION {
                runner_up = distance;
            }
        }
        let (faces_a, faces_b) = self.axes.distances.split_at(a.faces.len());
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

    /// How far `axis` parts them now, m; `None` where its edges are none of the outermost any more.
    pub(crate) fn distance_along(
        (a, b): (&Polytope, &Polytope),
        relative: &Relative,
        axis: Axis,
    ) -> Option<f64> {
        match axis {
            Axis::FaceOfA(face) => {
                let face = &a.faces[face as usize];
                let down = -relative.rotation.tr_mul(&face.normal);
                let lowest = relative.point(&b.vertices[b.support(&down)]);
                Some(face.normal.dot(&lowest) - face.offset)
            }
            Axis::FaceOfB(face) => {
                let face = &b.faces[face as usize];
                let down = -(relative.rotation * face.normal);
                let lowest = relative.rotation.tr_mul(&(a.vertices[a.support(&down)] - relative.translation));
                Some(face.normal.dot(&lowest) - face.offset)
            }
            Axis::Edges(..) => None,
        }
    }

    /// Signed distances of the faces of A from B and of those of B from A, as of the last query; where that ended
    /// early, of A's alone.
    pub(crate) fn face_distances(&self, faces_of_a: usize) -> (&[f32], &[f32]) {
        self.axes.distances.split_at(self.axes.distances.len().min(faces_of_a))
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
            Axis::Edges(i, j) => edges::point((a, b), relative, (i, j), reach, region),
        }
    }
}

/// What no axis can part two polytopes by more than, m, given a point of each in its own frame. Apart, two points of
/// them are no nearer than they are; and to get a point of one that lies in the other out of there, it has to be moved by
/// its depth at least.
pub(crate) fn most((a, b): (&Polytope, &Polytope), relative: &Relative, [of_a, of_b]: &[Vec3; 2]) -> f64 {
    let seen_a = relative.point(of_b);
    let in_a = a.height(&seen_a);
    let in_b = b.height(&relative.rotation.tr_mul(&(of_a - relative.translation)));
    if in_a.min(in_b) < 0.0 { in_a.min(in_b) } else { (seen_a - of_a).norm() }
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

fn index(i: usize) -> u32 {
    u32::try_from(i).unwrap_or(u32::MAX)
}
