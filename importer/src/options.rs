//! The limits and tolerances of an import.

use serde::{Deserialize, Serialize};

use crate::{ALGORITHM_VERSION, Alone, ShapesReader};

/// Limits and tolerances. All are counters or ratios, never clocks, so that the same file gives the same asset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Options {
    /// Most corners of a collider hull.
    pub hull_vertices: usize,
    /// Error a collider may have, as a share of the mesh's diagonal.
    pub collider_tolerance: f64,
    /// A part gets a ladder of its own where the asset has from two up to this many parts.
    pub part_ladders: usize,
    /// Largest file that is read, and largest sum of it and the buffers it refers to, in bytes.
    pub max_file_bytes: u64,
    /// Most triangles an asset may come to once its nodes are followed.
    pub max_triangles: u64,
    /// Most cells a grid of voxels may have, filled or not.
    pub max_voxels: u64,
    /// Cells along the longest side of the field that a surface is laid through points in, at most.
    pub cloud_cells: usize,
    /// A mesh of more triangles gets no convex decomposition.
    pub max_decomposition_triangles: u64,
    /// Voxels along the longest side in a convex decomposition.
    pub decomposition_resolution: u32,
    /// Most pieces of a convex decomposition.
    pub decomposition_pieces: usize,
    /// A mesh of more triangles gets no triangle mesh collider.
    pub max_collider_triangles: u64,
    /// Points sampled on the mesh to measure a collider's error.
    pub error_samples: usize,
    /// Who reads `*.shapes.yaml`; without one they are refused.
    #[serde(skip)]
    pub shapes: Option<ShapesReader>,
    /// Collider candidates are made; without them a batch only reads, measures and stores.
    pub with_colliders: bool,
    /// How a model that was in work when a run died is imported; without it, as any other.
    #[serde(skip)]
    pub alone: Option<Alone>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            hull_vertices: 64,
            collider_tolerance: 0.02,
            part_ladders: 16,
            max_file_bytes: 2 << 30,
            max_triangles: 20_000_000,
            max_voxels: 1 << 28,
            cloud_cells: 56,
            max_decomposition_triangles: 200_000,
            decomposition_resolution: 96,
            decomposition_pieces: 128,
            max_collider_triangles: 1_000_000,
            error_samples: 2_000,
            shapes: None,
            with_colliders: true,
            alone: None,
        }
    }
}

impl Options {
    /// Everything that can change an asset apart from its bytes: the algorithm's version and every option.
    /// Two imports of equal bytes with equal fingerprints give equal assets.
    #[must_use]
    pub fn fingerprint(&self) -> String {
        format!(
            "v{ALGORITHM_VERSION} hull={} tolerance={} parts={} bytes={} triangles={} voxels={} cloud={} decomposition={}/{}/{} \
             mesh={} samples={} shapes={} colliders={}",
            self.hull_vertices,
            self.collider_tolerance,
            self.part_ladders,
            self.max_file_bytes,
            self.max_triangles,
            self.max_voxels,
            self.cloud_cells,
            self.max_decomposition_triangles,
            self.decomposition_resolution,
            self.decomposition_pieces,
            self.max_collider_triangles,
            self.error_samples,
            u8::from(self.shapes.is_some()),
            u8::from(self.with_colliders),
        )
    }
}
