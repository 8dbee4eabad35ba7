//! Why a scene is refused. Construction is the only place that refuses; a step reports instead.

/// A fault of a scene or of the settings, with the entity and the way out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// A number is NaN or infinite.
    #[error("entity {entity:?}: {what} is not finite; give a number")]
    NotFinite { entity: String, what: &'static str },
    /// A dynamic body without a positive mass.
    #[error(
        "entity {entity:?}: mass is {mass_kg} kg; a body that moves needs a mass above 0, or make it static"
    )]
    Mass { entity: String, mass_kg: f64 },
    /// No rigid body has this inertia tensor.
    #[error(
        "entity {entity:?}: principal moments {moments_kg_m2:?} kg m2 break the triangle inequality or are not \
         positive; compute them from the shape"
    )]
    Inertia { entity: String, moments_kg_m2: [f64; 3] },
    /// A shape's size is not positive, or its points span no volume.
    #[error("entity {entity:?}, shape {shape}: {fault}")]
    Shape { entity: String, shape: usize, fault: String },
    /// A surface that never ends, on a body that moves.
    #[error(
        "entity {entity:?}, shape {shape}: a {kind} has no inside; use convex pieces, or make the body static"
    )]
    StaticOnly { entity: String, shape: usize, kind: &'static str },
    /// Friction or rolling resistance below 0, restitution outside 0 to 1.
    #[error("entity {entity:?}, shape {shape}: {what} is {value}; expected {range}")]
    Surface { entity: String, shape: usize, what: &'static str, value: f64, range: &'static str },
    /// A known pair of materials with friction below 0 or restitution outside 0 to 1.
    #[error("pair of materials {between:?}: {what} is {value}; expected {range}")]
    Pair { between: [u32; 2], what: &'static str, value: f64, range: &'static str },
    /// An action on an entity that is not there, or before the start.
    #[error("action {action}: {fault}")]
    Action { action: usize, fault: String },
    /// A setting outside its range.
    #[error("setting {name} is {value}; expected {range}")]
    Setting { name: &'static str, value: f64, range: &'static str },
    /// The scene's gravity is not finite.
    #[error("gravity is not finite; give three numbers in m/s2")]
    Gravity,
}
