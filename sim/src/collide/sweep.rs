//! When two moving shapes first touch: conservative advancement (Mirtich 1996). Rotation counts: a rod that whirls into
//! a wall is found as surely as a bullet.

use crate::body::Body;
use crate::collide::convex::Core;
use crate::collide::gjk::CorePair;
use crate::collide::mesh::Mesh;
use crate::collide::polytope::Polytope;
use crate::collide::relative::Relative;
use crate::math::{Frame3, Vec3, rotated};
use crate::shape::{Aabb, Collider};

/// Advances before the search is stopped; what is then still on its way counts as touching.
const MAX_ADVANCES: u32 = 64;

/// A shape of a body that moves steadily.
#[derive(Clone, Copy)]
pub(crate) struct Mover<'a> {
    pub(crate) shape: &'a Collider,
    start: Frame3,
    velocity: Vec3,
    spin: Vec3,
    /// m/s that any point of the body moves beyond its centre of mass, at most.
    rim_speed: f64,
}

impl<'a> Mover<'a> {
    pub(crate) fn new(shape: &'a Collider, body: &Body) -> Self {
        let moves = body.is_awake();
        let of = |v: &Vec3| if moves { *v } else { Vec3::zeros() };
        let (velocity, spin) = (of(&body.velocity), of(&body.spin));
        Self { shape, start: body.frame(), velocity, spin, rim_speed: spin.norm() * body.reach }
    }

    /// Where the shape is `time` seconds on.
    pub(crate) fn at(&self, time: f64) -> Relative {
        if time == 0.0 {
            return self.shape.world;
        }
        let frame = Frame3 {
            position: self.start.position + self.velocity * time,
            rotation: rotated(&self.start.rotation, &(self.spin * time)),
        };
        self.shape.in_world(&(&frame).into())
    }
}

/// Two movers.
pub(crate) struct Sweep<'a> {
    pub(crate) a: Mover<'a>,
    pub(crate) b: Mover<'a>,
    /// s
    pub(crate) span: f64,
    /// m at which the surfaces count as touching.
    pub(crate) touching: f64,
}

impl Sweep<'_> {
    /// s until the surfaces touch, if they do within the span and approach as they do.
    pub(crate) fn meeting(&self, triangles: &mut Vec<u32>, sheet: &mut Polytope) -> Option<f64> {
        match (self.a.shape.geometry.mesh(), self.b.shape.geometry.mesh()) {
            (None, None) => {
                let (core_a, radius_a) = self.a.shape.geometry.core()?;
                let (core_b, radius_b) = self.b.shape.geometry.core()?;
                self.advance((core_a, core_b), radius_a + radius_b, self.span, |_| true)
            }
            (Some(mesh), None) => self.mesh_meeting(mesh, true, triangles, sheet),
            (None, Some(mesh)) => self.mesh_meeting(mesh, false, triangles, sheet),
            (Some(_), Some(_)) => None,
        }
    }

    /// The earliest meeting with a triangle that faces the other shape.
    fn mesh_meeting(
        &self,
        mesh: &Mesh,
        mesh_is_a: bool,
        triangles: &mut Vec<u32>,
        sheet: &mut Polytope,
    ) -> Option<f64> {
        let (ground, mover) = if mesh_is_a { (&self.a, &self.b) } else { (&self.b, &self.a) };
        let (core, radius) = mover.shape.geometry.core()?;
        let seen = |time: f64| ground.at(time).inverse_compose(&mover.at(time));
        let (start, end) = (seen(0.0), seen(self.span));
        let turning = (mover.rim_speed + ground.rim_speed) * self.span;
        let bounds: Aabb = mover.shape.bounds_at(&start).merged(&mover.shape.bounds_at(&end)).grown(turning);
        mesh.near(&bounds, triangles);
        let mut earliest: Option<f64> = None;
        for &index in triangles.iter() {
            let triangle = &mesh.triangles[index as usize];
            if triangle.height(&start.translation) < 0.0 {
                continue;
            }
            sheet.set_sheet(&triangle.corners, &triangle.normal);
            let cores = if mesh_is_a { (Core::Polytope(sheet), core) } else { (core, Core::Polytope(sheet)) };
            let limit = earliest.unwrap_or(self.span);
            let rotation = |time: f64| ground.at(time).rotation;
            let faces = |at: (f64, Vec3)| {
                // The way from the mesh to the other shape, in the world.
                let out = if mesh_is_a { at.1 } else { -at.1 };
                out.dot(&(rotation(at.0) * triangle.normal)) > 0.0
            };
            if let Some(time) = self.advance(cores, radius, limit, faces) {
                earliest = Some(time);
            }
        }
        earliest
    }

    /// s until two cores are `rounding` and a touch apart; `counts` judges the time and the normal (world, A to B).
    fn advance(
        &self,
        (core_a, core_b): (Core<'_>, Core<'_>),
        rounding: f64,
        limit: f64,
        counts: impl Fn((f64, Vec3)) -> bool,
    ) -> Option<f64> {
        let relative_velocity = self.b.velocity - self.a.velocity;
        let mut time = 0.0;
        let mut guess = Vec3::y();
        for _ in 0..MAX_ADVANCES {
            let (world_a, world_b) = (self.a.at(time), self.b.at(time));
            let pair = CorePair { a: core_a, b: core_b, relative: world_a.inverse_compose(&world_b) };
            // Cores that touch have met; so have surfaces that do.
            let Some(nearest) = pair.nearest(&guess, 0.1 * self.touching) else { return Some(time) };
            guess = nearest.normal;
            let normal = world_a.rotation * nearest.normal;
            let gap = nearest.distance - rounding;
            let closing = self.a.rim_speed + self.b.rim_speed - relative_velocity.dot(&normal);
            if gap <= self.touching {
                return counts((time, normal)).then_some(time);
            }
            if closing * (limit - time) <= gap - self.touching {
                return None;
            }
            time += (gap - 0.5 * self.touching) / closing;
            if time >= limit {
                return None;
            }
        }
        Some(time)
    }
}
