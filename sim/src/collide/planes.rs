//! The planes of a mesh that a convex shape touches: a manifold each, known again from step to step.

use crate::collide::cache::Cache;
use crate::collide::mesh::Mesh;
use crate::collide::narrow::NarrowBuffers;
use crate::collide::near::{AXIS_SHARE, GAP_SHARE, Holds, Near, REACH_IN_STOCK, UNSEEN_SHARE};
use crate::collide::relative::Relative;

/// Cosine above which the normals of two planes are those of one, from step to step.
const SAME_PLANE: f64 = 0.99;

impl Near<'_> {
    /// A mesh, which is A or B, and a convex shape: a manifold for every plane of the mesh that is near. A plane keeps
    /// its number while it turns little from step to step, so that what the solver knew of it is found again.
    pub(crate) fn surface(
        &self,
        (mesh, mesh_is_a): (&Mesh, bool),
        relative: &Relative,
        cache: &mut Cache<'_>,
        buffers: &mut NarrowBuffers,
    ) -> Holds {
        let (i, j) = self.key;
        let mut memory = cache.recall(self.key);
        if let Some((before, reach)) = &memory.region_at {
            let left = self.keep() - self.motion(relative, before);
            if self.reach <= *reach && left >= 0.0 {
                let holds = Holds::Stands { way: left.min(UNSEEN_SHARE * self.keep()), reach: *reach };
                cache.keep_all(self.key);
                cache.remember(memory);
                return holds;
            }
        }
        let NarrowBuffers { sat, touch, out, surface, named, .. } = buffers;
        let reach = REACH_IN_STOCK * self.reach;
        let (shape, seen) = if mesh_is_a { (self.b, *relative) } else { (self.a, relative.inverse()) };
        let lengths = (GAP_SHARE * shape.inner_radius, AXIS_SHARE * shape.inner_radius);
        surface.find(mesh, shape, &seen, reach, lengths, (sat, touch));

        named.clear();
        let world = if mesh_is_a { self.world_a.rotation } else { -self.world_b.rotation };
        for (plane, normal) in surface.normals.iter().enumerate() {
            let normal = world * normal;
            let known = cache.left(self.key).find(|manifold| {
                manifold.normal.dot(&normal) > SAME_PLANE
                    && !named.iter().any(|(name, _)| *name == manifold.key.2)
            });
            let taken = |name: &u32| {
                named.iter().any(|(other, _)| other == name)
                    || cache.left(self.key).any(|manifold| manifold.key.2 == *name)
            };
            let name = known.map_or_else(|| (0..).find(|name| !taken(name)).unwrap_or(0), |m| m.key.2);
            named.push((name, plane));
        }
        named.sort_unstable();
        let mut rolls = false;
        for &(name, plane) in named.iter() {
            surface.region(plane, &mut out.region);
            if !mesh_is_a {
                out.region.flip(relative);
            }
            rolls |= self.write(relative, cache, out, name);
        }
        cache.drop_left((i, j));
        let kept = !rolls && !named.is_empty();
        memory.region_at = kept.then_some((*relative, reach));
        cache.remember(memory);
        if kept {
            Holds::Stands { way: UNSEEN_SHARE * self.keep(), reach }
        } else if surface.is_far() {
            Holds::Apart(reach)
        } else {
            Holds::Once
        }
    }
}
