//! A piece of the mesh's surface: clipping by planes, connected components.

use std::collections::HashMap;

use super::prepared::{Vec3, bounds};
use super::sets::Sets;

/// Points nearer than this to a cutting plane lie on it.
pub(super) const ON_PLANE: f64 = 1e-6;

/// A plane `normal·p = offset`; its lower side is where `normal·p` is less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    pub normal: Vec3,
    pub offset: f64,
}

impl Plane {
    pub fn above(&self, p: &Vec3) -> f64 {
        self.normal.dot(p) - self.offset
    }

    /// Whether it is the plane of this face, either way round.
    pub fn holds(&self, (normal, offset): &(Vec3, f64)) -> bool {
        let along = self.normal.dot(normal);
        along.abs() > 1.0 - 1e-6 && (self.offset * along - offset).abs() < 1e-4
    }
}

/// An indexed triangle surface, open or closed.
#[derive(Clone, Debug, Default)]
pub(super) struct Surface {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// What lies below and what lies above the plane. A triangle in the plane goes to the side its solid
    /// is on, which its winding tells.
    pub fn cut(&self, plane: &Plane) -> [Self; 2] {
        let heights: Vec<f64> = self.positions.iter().map(|p| plane.above(p)).collect();
        [self.keep(&heights, plane, -1.0), self.keep(&heights, plane, 1.0)]
    }

    fn keep(&self, heights: &[f64], plane: &Plane, sign: f64) -> Self {
        let mut kept = Self::default();
        // Lookup only; ids are given in order of first use.
        let mut ids: HashMap<(u32, u32), u32> = HashMap::new();
        for triangle in &self.triangles {
            let height = triangle.map(|i| heights[i as usize] * sign);
            if !takes(height, || self.normal(triangle).dot(&plane.normal) * sign < 0.0) {
                continue;
            }
            let mut polygon: Vec<u32> = Vec::with_capacity(4);
            let mut corner = |key: (u32, u32), p: Vec3| {
                let id = *ids.entry(key).or_insert_with(|| {
                    kept.positions.push(p);
                    (kept.positions.len() - 1) as u32
                });
                if !polygon.contains(&id) {
                    polygon.push(id);
                }
            };
            for i in 0..3 {
                let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
                let (ha, hb) = (height[i], height[(i + 1) % 3]);
                if ha >= -ON_PLANE {
                    corner((a, a), self.positions[a as usize]);
                }
                if let Some(t) = crossing(ha, hb) {
                    let (p, q) = (self.positions[a as usize], self.positions[b as usize]);
                    corner((a.min(b), a.max(b)), p + (q - p) * t);
                }
            }
            for i in 2..polygon.len() {
                kept.triangles.push([polygon[0], polygon[i - 1], polygon[i]]);
            }
        }
        kept
    }

    pub fn append(&mut self, other: &Self) {
        let offset = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + offset)));
    }

    pub fn normal(&self, triangle: &[u32; 3]) -> Vec3 {
        let [a, b, c] = triangle.map(|i| self.positions[i as usize]);
        (b - a).cross(&(c - a))
    }

    /// Connected parts, those inside the bounds of another put with it: a cavity belongs to what is around it.
    pub fn components(&self) -> Vec<Self> {
        let mut sets = Sets::new(self.positions.len());
        for [a, b, c] in &self.triangles {
            sets.join(*a, *b);
            sets.join(*a, *c);
        }
        let mut groups: Vec<Vec<u32>> = Vec::new();
        let mut group_of = vec![u32::MAX; self.positions.len()];
        for (t, triangle) in self.triangles.iter().enumerate() {
            let root = sets.root(triangle[0]) as usize;
            if group_of[root] == u32::MAX {
                group_of[root] = groups.len() as u32;
                groups.push(Vec::new());
            }
            groups[group_of[root] as usize].push(t as u32);
        }
        if groups.len() < 2 {
            return vec![self.clone()];
        }
        let corners = |group: &Vec<u32>| -> Vec<Vec3> {
            group
                .iter()
                .flat_map(|&t| self.triangles[t as usize])
                .map(|i| self.positions[i as usize])
                .collect()
        };
        let boxes: Vec<(Vec3, Vec3)> = groups.iter().map(|group| bounds(&corners(group))).collect();
        let owner = owners(&boxes);
        (0..groups.len())
            .filter(|&g| owner[g] == g)
            .map(|g| {
                let mine = (0..groups.len()).filter(|&other| owner[other] == g);
                self.pick(mine.flat_map(|other| groups[other].iter().copied()))
            })
            .collect()
    }

    fn pick(&self, triangles: impl Iterator<Item = u32>) -> Self {
        let mut new_index = vec![u32::MAX; self.positions.len()];
        let mut picked = Self::default();
        for t in triangles {
            picked.triangles.push(self.triangles[t as usize].map(|i| {
                if new_index[i as usize] == u32::MAX {
                    new_index[i as usize] = picked.positions.len() as u32;
                    picked.positions.push(self.positions[i as usize]);
                }
                new_index[i as usize]
            }));
        }
        picked
    }

    /// Corner points of the connected parts on either side of the plane, without building their surfaces.
    pub fn cut_points(&self, plane: &Plane) -> [Vec<Vec<Vec3>>; 2] {
        let heights: Vec<f64> = self.positions.iter().map(|p| plane.above(p)).collect();
        [-1.0, 1.0].map(|sign| {
            let mut sets = Sets::new(self.positions.len());
            let mut used = vec![false; self.positions.len()];
            let mut cuts: Vec<(u32, Vec3)> = Vec::new();
            for triangle in &self.triangles {
                let height = triangle.map(|i| heights[i as usize] * sign);
                if !takes(height, || self.normal(triangle).dot(&plane.normal) * sign < 0.0) {
                    continue;
                }
                let mut first = None;
                for i in 0..3 {
                    let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
                    if height[i] >= -ON_PLANE {
                        used[a as usize] = true;
                        match first {
                            None => first = Some(a),
                            Some(known) => sets.join(known, a),
                        }
                    }
                    if let Some(t) = crossing(height[i], height[(i + 1) % 3]) {
                        let (p, q) = (self.positions[a as usize], self.positions[b as usize]);
                        cuts.push((if height[i] > 0.0 { a } else { b }, p + (q - p) * t));
                    }
                }
            }
            let mut groups: Vec<Vec<Vec3>> = Vec::new();
            let mut group_of = vec![u32::MAX; self.positions.len()];
            let corners = (0..used.len()).filter(|&i| used[i]).map(|i| (i as u32, self.positions[i]));
            for (i, p) in corners.chain(cuts) {
                let root = sets.root(i) as usize;
                if group_of[root] == u32::MAX {
                    group_of[root] = groups.len() as u32;
                    groups.push(Vec::new());
                }
                groups[group_of[root] as usize].push(p);
            }
            let boxes: Vec<(Vec3, Vec3)> = groups.iter().map(|group| bounds(group)).collect();
            let owner = owners(&boxes);
            for g in 0..groups.len() {
                if owner[g] != g {
                    let moved = std::mem::take(&mut groups[g]);
                    groups[owner[g]].extend(moved);
                }
            }
            groups.retain(|group| !group.is_empty());
            groups
        })
    }
}

/// Whether a triangle of these heights has something on the positive side.
fn takes(height: [f64; 3], in_plane: impl Fn() -> bool) -> bool {
    let top = height[0].max(height[1]).max(height[2]);
    top > ON_PLANE || (top >= -ON_PLANE && height.iter().all(|h| h.abs() <= ON_PLANE) && in_plane())
}

/// Where along an edge the plane is crossed, if its ends lie clearly on different sides.
fn crossing(a: f64, b: f64) -> Option<f64> {
    ((a > ON_PLANE && b < -ON_PLANE) || (a < -ON_PLANE && b > ON_PLANE)).then(|| a / (a - b))
}

/// For each box the outermost box around it, or itself.
fn owners(boxes: &[(Vec3, Vec3)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    let size = |i: usize| (boxes[i].1 - boxes[i].0).norm_squared();
    order.sort_by(|&a, &b| size(b).total_cmp(&size(a)).then(a.cmp(&b)));
    let mut owner: Vec<usize> = (0..boxes.len()).collect();
    let mut outer: Vec<usize> = Vec::new();
    for i in order {
        let (low, high) = boxes[i];
        let around = outer.iter().copied().find(|&o| {
            (0..3).all(|k| boxes[o].0[k] <= low[k] + ON_PLANE && boxes[o].1[k] >= high[k] - ON_PLANE)
        });
        match around {
            Some(o) => owner[i] = o,
            None => outer.push(i),
        }
    }
    owner
}
