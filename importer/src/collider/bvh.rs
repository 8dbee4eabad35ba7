//! A tree of boxes over triangles: nearest point, and what a ray meets.

use super::prepared::{Prepared, Vec3, bounds};

const LEAF: usize = 4;
/// Cosine of the angle to a face's normal within which a foot lies inside of the face.
const STRAIGHT: f64 = 1.0 - 1e-9;

struct Node {
    low: Vec3,
    high: Vec3,
    /// Range of `order` in a leaf; children `first` and `first + 1` where `count` is zero.
    first: u32,
    count: u32,
}

/// Triangles in a tree of axis-aligned boxes.
pub(super) struct Bvh {
    nodes: Vec<Node>,
    triangles: Vec<[Vec3; 3]>,
    ids: Vec<u32>,
}

/// What a query found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub distance: f64,
    pub foot: Vec3,
    /// Its place in the tree.
    pub triangle: usize,
}

impl Bvh {
    pub fn of_mesh(mesh: &Prepared) -> Self {
        Self::new((0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect())
    }

    pub fn new(triangles: Vec<[Vec3; 3]>) -> Self {
        let centres: Vec<Vec3> = triangles.iter().map(|[a, b, c]| (a + b + c) / 3.0).collect();
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let mut nodes =
            vec![Node { low: Vec3::zeros(), high: Vec3::zeros(), first: 0, count: order.len() as u32 }];
        let mut open = vec![0usize];
        while let Some(index) = open.pop() {
            let range = nodes[index].first as usize..(nodes[index].first + nodes[index].count) as usize;
            let mine = &mut order[range.clone()];
            let mut low = Vec3::repeat(f64::INFINITY);
            let mut high = Vec3::repeat(f64::NEG_INFINITY);
            for &t in mine.iter() {
                let (l, h) = bounds(&triangles[t as usize]);
                low = low.inf(&l);
                high = high.sup(&h);
            }
            nodes[index].low = low;
            nodes[index].high = high;
            if mine.len() <= LEAF {
                continue;
            }
            let axis = (high - low).imax();
            let middle = mine.len() / 2;
            mine.select_nth_unstable_by(middle, |&a, &b| {
                centres[a as usize][axis].total_cmp(&centres[b as usize][axis]).then(a.cmp(&b))
            });
            let left = nodes.len();
            let child = |first, count| Node {
                low: Vec3::zeros(),
                high: Vec3::zeros(),
                first: first as u32,
                count: count as u32,
            };
            nodes.push(child(range.start, middle));
            nodes.push(child(range.start + middle, range.len() - middle));
            nodes[index].first = left as u32;
            nodes[index].count = 0;
            open.extend([left, left + 1]);
        }
        let triangles = order.iter().map(|&t| triangles[t as usize]).collect();
        Self { nodes, triangles, ids: order }
    }

    /// The nearest point within `limit` of `p`.
    pub fn nearest(&self, p: Vec3, limit: f64) -> Option<Nearest> {
        self.nearest_where(p, limit, |_, _| true)
    }

    /// The nearest of the triangles' own nearest points that `accepts(triangle, point)`.
    pub fn nearest_where(
        &self,
        p: Vec3,
        limit: f64,
        accepts: impl Fn(usize, Vec3) -> bool,
    ) -> Option<Nearest> {
        if self.triangles.is_empty() {
            return None;
        }
        let mut best = limit * limit;
        let mut found: Option<(usize, Vec3)> = None;
        let mut open: Vec<(u32, f64)> = Vec::with_capacity(64);
        open.push((0, box_distance_squared(p, &self.nodes[0])));
        while let Some((index, gap)) = open.pop() {
            if gap >= best {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                for t in node.first as usize..(node.first + node.count) as usize {
                    let q = closest_on_triangle(p, &self.triangles[t]);
                    let gap = (q - p).norm_squared();
                    if gap < best && accepts(self.ids[t] as usize, q) {
                        best = gap;
                        found = Some((t, q));
                    }
                }
                continue;
            }
            let (a, b) = (node.first, node.first + 1);
            let gap_a = box_distance_squared(p, &self.nodes[a as usize]);
            let gap_b = box_distance_squared(p, &self.nodes[b as usize]);
            // The nearer one is looked at first: it is pushed last.
            if gap_a < gap_b {
                open.extend([(b, gap_b), (a, gap_a)]);
            } else {
                open.extend([(a, gap_a), (b, gap_b)]);
            }
        }
        found.map(|(triangle, foot)| Nearest { distance: best.sqrt(), foot, triangle })
    }

    /// Some triangle that the ray from `origin` meets, by its place in the tree. `direction` has no zero entry.
    pub fn first_stop(&self, origin: Vec3, direction: Vec3) -> Option<usize> {
        if self.triangles.is_empty() {
            return None;
        }
        let inverse = direction.map(|x| 1.0 / x);
        // The tree halves at every node: its depth is that of the count's logarithm.
        let mut open = [0u32; 64];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let node = &self.nodes[open[count] as usize];
            let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
            for k in 0..3 {
                let a = (node.low[k] - origin[k]) * inverse[k];
                let b = (node.high[k] - origin[k]) * inverse[k];
                enter = enter.max(a.min(b));
                leave = leave.min(a.max(b));
            }
            if enter > leave * (1.0 + 1e-12) + 1e-15 {
                continue;
            }
            if node.count == 0 {
                open[count] = node.first + 1;
                open[count + 1] = node.first;
                count += 2;
                continue;
            }
            let mut range = node.first as usize..(node.first + node.count) as usize;
            let met = range.find(|&t| self.stops(t, origin, direction));
            if met.is_some() {
                return met;
            }
        }
        None
    }

    /// Whether `p` lies straight behind the face that `nearest` found for it: within the solid, where the surface is
    /// closed and wound outwards. A foot on an edge or a corner tells nothing and is no.
    pub fn is_behind(&self, p: Vec3, nearest: &Nearest) -> bool {
        let [a, b, c] = &self.triangles[nearest.triangle];
        let normal = (b - a).cross(&(c - a));
        (p - nearest.foot).dot(&normal) < -STRAIGHT * nearest.distance * normal.norm()
    }

    /// Whether the ray meets the triangle at this place in the tree.
    pub fn stops(&self, triangle: usize, origin: Vec3, direction: Vec3) -> bool {
        ray_meets(origin, direction, &self.triangles[triangle])
    }
}

fn box_distance_squared(p: Vec3, node: &Node) -> f64 {
    let mut sum = 0.0;
    for axis in 0..3 {
        let gap = (node.low[axis] - p[axis]).max(p[axis] - node.high[axis]).max(0.0);
        sum += gap * gap;
    }
    sum
}

fn ray_meets(origin: Vec3, direction: Vec3, [a, b, c]: &[Vec3; 3]) -> bool {
    let (e1, e2) = (b - a, c - a);
    let h = direction.cross(&e2);
    let det = e1.dot(&h);
    if det == 0.0 {
        return false;
    }
    let s = origin - a;
    let u = s.dot(&h) / det;
    if !(0.0..=1.0).contains(&u) {
        return false;
    }
    let q = s.cross(&e1);
    let v = direction.dot(&q) / det;
    v >= 0.0 && u + v <= 1.0 && e2.dot(&q) / det > 0.0
}

/// Ericson, Real-Time Collision Detection, 5.1.5.
pub(super) fn closest_on_triangle(p: Vec3, [a, b, c]: &[Vec3; 3]) -> Vec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    let (d43, d56) = (d4 - d3, d5 - d6);
    if va <= 0.0 && d43 >= 0.0 && d56 >= 0.0 && d43 + d56 > 0.0 {
        return b + (c - b) * (d43 / (d43 + d56));
    }
    let total = va + vb + vc;
    if total == 0.0 {
        return *a;
    }
    a + ab * (vb / total) + ac * (vc / total)
}

#[cfg(test)]
mod tests {
    use super::super::hull::Hull;
    use super::super::sampling::r3;
    use super::super::sight::Sight;
    use super::*;

    #[test]
    fn what_lies_behind_a_face_of_a_closed_surface_sees_no_way_out() {
        let (low, high) = (Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.5, 0.7, 0.6));
        let tree = Bvh::new(Hull::of_box(low, high).face_points().collect());
        let mut sight = Sight::new(&tree);
        let mut behind = 0;
        for p in (0..400).map(r3) {
            let nearest = tree.nearest(p, 2.0).expect("a box has faces");
            assert!((nearest.distance - (nearest.foot - p).norm()).abs() < 1e-12);
            let inside = (0..3).all(|k| p[k] > low[k] && p[k] < high[k]);
            assert_eq!(tree.is_behind(p, &nearest), inside, "{p:?}");
            assert_eq!(sight.sees_out(p), !inside, "{p:?}");
            behind += usize::from(inside);
        }
        assert!(behind > 10, "{behind}");
    }
}
