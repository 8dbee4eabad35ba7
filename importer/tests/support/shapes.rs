//! Meshes of known mass properties.

use std::f64::consts::TAU;

use importer::Mesh;

/// An axis-aligned box of 12 triangles.
pub fn cuboid(min: [f64; 3], max: [f64; 3]) -> Mesh {
    let positions = (0..8)
        .map(|bits| std::array::from_fn(|axis| if bits >> axis & 1 == 0 { min[axis] } else { max[axis] }))
        .collect();
    let quads: [[u32; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { positions, triangles }
}

pub fn tetrahedron(corners: [[f64; 3]; 4]) -> Mesh {
    Mesh { positions: corners.to_vec(), triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] }
}

/// A sphere of unit radius by a grid of `n` by `2 n` on the faces of an octahedron.
pub fn sphere(n: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for octant in 0..8_u32 {
        let sign: [f64; 3] = std::array::from_fn(|axis| if octant >> axis & 1 == 0 { 1.0 } else { -1.0 });
        let mut piece = Mesh::default();
        let number = |i: u32, j: u32| (0..i).map(|row| n + 1 - row).sum::<u32>() + j;
        for i in 0..=n {
            for j in 0..=n - i {
                let point = [i, j, n - i - j].map(f64::from);
                let length = point.iter().map(|value| value * value).sum::<f64>().sqrt();
                piece.positions.push(std::array::from_fn(|axis| sign[axis] * point[axis] / length));
                if i + j < n {
                    piece.triangles.push([number(i, j), number(i + 1, j), number(i, j + 1)]);
                }
                if i + j + 1 < n {
                    piece.triangles.push([number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)]);
                }
            }
        }
        if octant.count_ones() % 2 == 1 {
            inside_out(&mut piece);
        }
        mesh.append(&piece);
    }
    mesh
}

/// Around Z, of radii `big` and `small`, with `n` and `n` segments.
pub fn torus(big: f64, small: f64, n: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let at = |i: u32, j: u32| (i % n) * n + j % n;
    for i in 0..n {
        for j in 0..n {
            let (u, v) = (TAU * f64::from(i) / f64::from(n), TAU * f64::from(j) / f64::from(n));
            let ring = big + small * v.cos();
            mesh.positions.push([ring * u.cos(), ring * u.sin(), small * v.sin()]);
            mesh.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            mesh.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    mesh
}

pub fn inside_out(mesh: &mut Mesh) {
    mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
}
