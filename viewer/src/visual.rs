//! What a body looks like: triangles from whoever read the model.

/// A piece of a model in one colour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VisualMesh {
    /// m, in the body's frame: origin at the centre of mass, the scene's axes at rotation identity.
    pub positions: Vec<[f32; 3]>,
    /// Counter-clockwise seen from outside, indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// sRGB and alpha, 0 to 255.
    pub color: [u8; 4],
}

/// The look of one entity of a scene. An entity without one is drawn by its shapes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Visual {
    /// Index into [`sim::Scene::entities`].
    pub entity: usize,
    pub meshes: Vec<VisualMesh>,
}

/// A collider's own triangles, drawn in place of a tessellation of its [`sim::Shape`]s.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColliderMesh {
    /// Index into [`sim::Scene::entities`].
    pub entity: usize,
    /// m, in the body's frame.
    pub positions: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
}
