//! How often a surface winds around a point, in a tree: near triangles one by one, far ones together.
//!
//! G. Barill, N. G. Dickson, R. Schmidt, D. I. W. Levin, A. Jacobson, Fast Winding Numbers for Soups and Clouds, 2018:
//! the expansion of their equation 15 up to its second term.

use std::f64::consts::PI;

use super::moments::{Point, cross, dot, minus, norm};

/// A node is far where the point is more than so many of its radii away.
const FAR: f64 = 2.0;
const LEAF: usize = 8;

/// A piece of surface: a triangle, or a disc around a point of a cloud.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Element {
    Triangle([Point; 3]),
    /// `vector` is normal times area.
    Disc {
        centre: Point,
        vector: Point,
    },
}

pub(crate) struct WindingTree {
    nodes: Vec<Node>,
    elements: Vec<Element>,
}

struct Node {
    centre: Point,
    radius: f64,
    /// Σ area · normal.
    dipole: Point,
    /// Σ (element's centre - centre) (area · normal)ᵀ, row by row.
    moment: [Point; 3],
    /// Elements of a leaf; of others the number of the first child, the second following it.
    first: usize,
    count: usize,
}

impl Element {
    fn centre(&self) -> Point {
        match self {
            Self::Triangle([a, b, c]) => std::array::from_fn(|axis| (a[axis] + b[axis] + c[axis]) / 3.0),
            Self::Disc { centre, .. } => *centre,
        }
    }

    fn vector(&self) -> Point {
        match self {
            Self::Triangle([a, b, c]) => cross(minus(*b, *a), minus(*c, *a)).map(|value| 0.5 * value),
            Self::Disc { vector, .. } => *vector,
        }
    }

    fn radius_about(&self, centre: Point) -> f64 {
        match self {
            Self::Triangle(corners) => {
                corners.iter().map(|&corner| norm(minus(corner, centre))).fold(0.0, f64::max)
            }
            Self::Disc { centre: own, vector } => norm(minus(*own, centre)) + (norm(*vector) / PI).sqrt(),
        }
    }

    /// Solid angle, positive where the outside looks away. A. van Oosterom, J. Strackee, The Solid Angle of a Plane
    /// Triangle, 1983.
    fn solid_angle(&self, point: Point) -> f64 {
        match self {
            Self::Triangle(corners) => {
                let [a, b, c] = corners.map(|corner| minus(corner, point));
                let (la, lb, lc) = (norm(a), norm(b), norm(c));
                let across = dot(a, cross(b, c));
                let along = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
                2.0 * across.atan2(along)
            }
            // Of the disc seen from the side rather than of a point: finite near by, and the same far away.
            Self::Disc { centre, vector } => {
                let towards = minus(*centre, point);
                let size = norm(*vector) / PI;
                dot(*vector, towards) / (dot(towards, towards) + size).powf(1.5)
            }
        }
    }
}

impl WindingTree {
    pub fn new(mut elements: Vec<Element>) -> Self {
        let mut nodes = Vec::new();
        let mut open = vec![(0, 0, elements.len())];
        nodes.push(Node::of(&elements, 0));
        while let Some((at, first, count)) = open.pop() {
            if count <= LEAF {
                continue;
            }
            let mine = &mut elements[first..first + count];
            let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
            for centre in mine.iter().map(Element::centre) {
                low = std::array::from_fn(|axis| low[axis].min(centre[axis]));
                high = std::array::from_fn(|axis| high[axis].max(centre[axis]));
            }
            let extent = minus(high, low);
            let axis = (0..3).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best });
            let half = count / 2;
            mine.select_nth_unstable_by(half, |a, b| a.centre()[axis].total_cmp(&b.centre()[axis]));
            let child = nodes.len();
            nodes.push(Node::of(&elements[first..first + half], first));
            nodes.push(Node::of(&elements[first + half..first + count], first + half));
            (nodes[at].first, nodes[at].count) = (child, 0);
            open.extend([(child, first, half), (child + 1, first + half, count - half)]);
        }
        Self { nodes, elements }
    }

    /// 1 inside of a closed surface, 0 outside, between them where it has holes.
    pub fn at(&self, point: Point) -> f64 {
        let mut angle = 0.0;
        let mut open = Vec::with_capacity(64);
        open.push(0);
        while let Some(at) = open.pop() {
            let node = &self.nodes[at];
            let towards = minus(node.centre, point);
            let squared = dot(towards, towards);
            if squared > FAR * FAR * node.radius * node.radius {
                angle += node.far(towards, squared);
            } else if node.count > 0 {
                let elements = &self.elements[node.first..node.first + node.count];
                angle += elements.iter().map(|element| element.solid_angle(point)).sum::<f64>();
            } else if !self.elements.is_empty() {
                open.extend([node.first, node.first + 1]);
            }
        }
        angle / (4.0 * PI)
    }

    /// Whether no element comes nearer than `distance`; may say no where none does.
    pub fn is_clear(&self, point: Point, distance: f64) -> bool {
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            let node = &self.nodes[at];
            if norm(minus(node.centre, point)) > node.radius + distance {
                continue;
            }
            if node.count > 0 {
                let near = |element: &Element| {
                    let centre = element.centre();
                    norm(minus(centre, point)) <= element.radius_about(centre) + distance
                };
                if self.elements[node.first..node.first + node.count].iter().any(near) {
                    return false;
                }
            } else if !self.elements.is_empty() {
                open.extend([node.first, node.first + 1]);
            }
        }
        true
    }
}

impl Node {
    fn of(elements: &[Element], first: usize) -> Self {
        let mut weight = 0.0;
        let (mut centre, mut dipole) = ([0.0; 3], [0.0; 3]);
        for element in elements {
            let vector = element.vector();
            let area = norm(vector).max(f64::MIN_POSITIVE);
            let middle = element.centre();
            weight += area;
            for axis in 0..3 {
                centre[axis] += area * middle[axis];
                dipole[axis] += vector[axis];
            }
        }
        let centre = centre.map(|value| if weight > 0.0 { value / weight } else { 0.0 });
        let mut moment = [[0.0; 3]; 3];
        let mut radius = 0.0_f64;
        for element in elements {
            let (offset, vector) = (minus(element.centre(), centre), element.vector());
            for row in 0..3 {
                for column in 0..3 {
                    moment[row][column] += offset[row] * vector[column];
                }
            }
            radius = radius.max(element.radius_about(centre));
        }
        Self { centre, radius, dipole, moment, first, count: elements.len() }
    }

    fn far(&self, towards: Point, squared: f64) -> f64 {
        let distance = squared.sqrt();
        let cubed = squared * distance;
        let trace = self.moment[0][0] + self.moment[1][1] + self.moment[2][2];
        let along = dot(towards, self.moment.map(|row| dot(row, towards)));
        dot(self.dipole, towards) / cubed + trace / cubed - 3.0 * along / (cubed * squared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube of unit side about the origin, each face cut into `n` by `n` squares.
    fn cube(n: u32) -> Vec<Element> {
        let mut elements = Vec::new();
        for face in 0..6_usize {
            let (axis, sign) = (face / 2, if face % 2 == 0 { -0.5 } else { 0.5 });
            let at = |u: u32, v: u32| {
                let mut point = [0.0; 3];
                point[axis] = sign;
                point[(axis + 1) % 3] = f64::from(u) / f64::from(n) - 0.5;
                point[(axis + 2) % 3] = f64::from(v) / f64::from(n) - 0.5;
                point
            };
            for u in 0..n {
                for v in 0..n {
                    let quad = [at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)];
                    for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
                        let (b, c) = if sign > 0.0 { (b, c) } else { (c, b) };
                        elements.push(Element::Triangle([quad[a], quad[b], quad[c]]));
                    }
                }
            }
        }
        elements
    }

    #[test]
    fn one_inside_and_nothing_outside() {
        let tree = WindingTree::new(cube(12));
        for (point, expected) in [
            ([0.0, 0.1, -0.2], 1.0),
            ([0.45, 0.45, 0.4], 1.0),
            ([0.6, 0.0, 0.0], 0.0),
            ([5.0, -3.0, 2.0], 0.0),
        ] {
            assert!((tree.at(point) - expected).abs() < 0.03, "{point:?}: {}", tree.at(point));
        }
        assert!(tree.is_clear([0.0; 3], 0.3) && !tree.is_clear([0.0; 3], 0.6));
    }

    #[test]
    fn the_tree_agrees_with_the_sum() {
        let elements = cube(10);
        let half: Vec<Element> = elements.into_iter().step_by(2).collect();
        let tree = WindingTree::new(half.clone());
        for point in [[0.1, 0.2, 0.3], [0.9, -0.3, 0.2], [0.0, 2.0, 0.0]] {
            let sum: f64 = half.iter().map(|element| element.solid_angle(point)).sum::<f64>() / (4.0 * PI);
            assert!((tree.at(point) - sum).abs() < 5e-3, "{point:?}");
        }
    }
}
