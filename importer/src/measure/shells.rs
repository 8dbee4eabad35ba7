//! Surfaces that hang together by edges, each turned so that it encloses a volume, where it does.

use crate::asset::Mesh;

use super::moments::Volume;
use super::topology::{Sets, edges, sides};

/// Triangles connected by edges.
#[derive(Debug)]
pub(super) struct Shell {
    pub triangles: Vec<[u32; 3]>,
    /// What it encloses, signed by its winding; `None` where it has a rim or no winding closes it.
    pub volume: Option<Volume>,
    /// Share of its triangles that were turned.
    pub turned: f64,
}

/// In order of their first triangle.
pub(super) fn shells(mesh: &Mesh) -> Vec<Shell> {
    let sides = sides(&mesh.triangles);
    let mut links = Links::new(mesh.triangles.len());
    for edge in edges(&sides) {
        if let [one, other] = edge {
            links.join(one.triangle, other.triangle, one.forward == other.forward);
        } else {
            edge.windows(2).for_each(|two| links.sets.join(two[0].triangle, two[1].triangle));
        }
    }
    // Parity is kept along edges of two; edges of more only join.
    #[allow(clippy::cast_possible_truncation)]
    let count = mesh.triangles.len() as u32;
    let against = links.minorities(count);
    let contradicted = links.contradicted;
    let (shell_of, shell_count) = links.sets.numbered(0..count);
    let mut drafts: Vec<Draft> = (0..shell_count).map(|_| Draft::default()).collect();
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        let draft = &mut drafts[shell_of[index] as usize];
        draft.triangles.push(*triangle);
        draft.against.push(against[index]);
        draft.contradicted |= contradicted[index];
    }
    for edge in edges(&sides) {
        let draft = &mut drafts[shell_of[edge[0].triangle as usize] as usize];
        let forward = edge.iter().filter(|side| side.forward).count();
        draft.unbalanced |= 2 * forward != edge.len();
        draft.manifold &= edge.len() == 2;
    }
    drafts.into_iter().map(|draft| draft.shell(&mesh.positions)).collect()
}

struct Draft {
    triangles: Vec<[u32; 3]>,
    /// Wound against most of those that it hangs together with.
    against: Vec<bool>,
    contradicted: bool,
    /// Some edge is run more often one way than the other.
    unbalanced: bool,
    /// Every edge has two triangles.
    manifold: bool,
}

impl Default for Draft {
    fn default() -> Self {
        let (triangles, against) = (Vec::new(), Vec::new());
        Self { triangles, against, contradicted: false, unbalanced: false, manifold: true }
    }
}

impl Draft {
    fn shell(mut self, positions: &[[f64; 3]]) -> Shell {
        // Where every edge is run as often one way as the other the surface has no rim, and the integral holds,
        // also where more than two triangles meet.
        if !self.unbalanced {
            let volume = Some(Volume::of(positions, &self.triangles));
            return Shell { triangles: self.triangles, volume, turned: 0.0 };
        }
        if self.contradicted {
            return Shell { triangles: self.triangles, volume: None, turned: 0.0 };
        }
        // Turn the smaller share: most of the winding is meant.
        for (triangle, _) in self.triangles.iter_mut().zip(&self.against).filter(|(_, against)| **against) {
            triangle.swap(1, 2);
        }
        let turned = self.against.iter().filter(|against| **against).count() as f64;
        let turned = turned / self.against.len() as f64;
        let volume = self.manifold.then(|| Volume::of(positions, &self.triangles));
        Shell { triangles: self.triangles, volume, turned }
    }
}

/// Union-find of triangles that also knows whether a triangle is wound as its set's first one.
struct Links {
    sets: Sets,
    /// Parent and whether wound against it, per triangle.
    parent: Vec<(u32, bool)>,
    contradicted: Vec<bool>,
}

impl Links {
    #[allow(clippy::cast_possible_truncation)]
    fn new(count: usize) -> Self {
        let parent = (0..count as u32).map(|triangle| (triangle, false)).collect();
        Self { sets: Sets::new(count), parent, contradicted: vec![false; count] }
    }

    /// Per triangle: whether it is wound against most of those it hangs together with by edges of two.
    fn minorities(&mut self, count: u32) -> Vec<bool> {
        let parity: Vec<(u32, bool)> = (0..count).map(|triangle| self.parity(triangle)).collect();
        let mut surplus = vec![0_i64; parity.len()];
        for &(root, flip) in &parity {
            surplus[root as usize] += if flip { 1 } else { -1 };
        }
        parity.iter().map(|&(root, flip)| flip != (surplus[root as usize] > 0)).collect()
    }

    fn parity(&mut self, triangle: u32) -> (u32, bool) {
        let mut against = false;
        let mut at = triangle;
        while self.parent[at as usize].0 != at {
            let (above, flip) = self.parent[at as usize];
            let (top, flip_above) = self.parent[above as usize];
            self.parent[at as usize] = (top, flip ^ (flip_above && top != above));
            let (next, flip) = self.parent[at as usize];
            against ^= flip;
            at = next;
        }
        (at, against)
    }

    fn join(&mut self, one: u32, other: u32, against: bool) {
        self.sets.join(one, other);
        let (root, flip) = self.parity(one);
        let (other_root, other_flip) = self.parity(other);
        let needed = flip ^ other_flip ^ against;
        if root == other_root {
            self.contradicted[one as usize] |= needed;
        } else {
            self.parent[root.max(other_root) as usize] = (root.min(other_root), needed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> Mesh {
        Mesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        }
    }

    #[test]
    fn any_flips_are_undone() {
        for flips in 0..16_u32 {
            let mut mesh = tetrahedron();
            for (at, triangle) in mesh.triangles.iter_mut().enumerate() {
                if flips >> at & 1 == 1 {
                    triangle.swap(0, 1);
                }
            }
            let shells = shells(&mesh);
            let volume = shells[0].volume.unwrap().total();
            assert!((volume.abs() - 1.0 / 6.0).abs() < 1e-15, "{flips:04b}");
            assert_eq!(shells[0].turned > 0.0, flips != 0 && flips != 15);
        }
    }

    #[test]
    fn a_rim_encloses_nothing() {
        let mut mesh = tetrahedron();
        mesh.triangles.pop();
        assert!(shells(&mesh)[0].volume.is_none());
    }

    #[test]
    fn a_moebius_band_has_no_winding() {
        let triangles: Vec<[u32; 3]> = (0..5).map(|at| [at, (at + 1) % 5, (at + 2) % 5]).collect();
        let positions = (0..5).map(|at| [f64::from(at), f64::from(at * at), 1.0]).collect();
        assert!(shells(&Mesh { positions, triangles }).iter().all(|shell| shell.volume.is_none()));
    }
}
