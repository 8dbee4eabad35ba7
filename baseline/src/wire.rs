//! A scene between two processes.
//!
//! A request is one JSON value:
//! `{ "want": "times" | "states", "steps", "dt_s", "substeps", "stiffness", "sleeping", "scene" }`.
//! rapier knows no rolling resistance, so that it stays behind. The answer is binary, little endian: for `times` an f64 a step, ms of CPU; for `states` a step is a byte that
//! says whether an action took effect, then 13 f64 an entity (position, rotation, linear and angular velocity).

use serde_json::{Value, json};
use sim::{
    Action, Change, ChildShape, Entity, HeightField, Mass, MaterialPair, Motion, Pose, Scene, Settings,
    Shape, Surface, Velocity,
};

/// Numbers of an entity's state.
pub const NUMBERS: usize = 13;

/// Which answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Want {
    Times,
    States,
}

/// A scene to be run.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    pub want: Want,
    pub steps: usize,
    pub settings: Settings,
    /// Frequency of the contact springs over rapier's.
    pub stiffness: f64,
    pub scene: Scene,
}

impl Request {
    #[must_use]
    pub fn to_json(&self) -> Value {
        json!({
            "want": match self.want { Want::Times => "times", Want::States => "states" },
            "steps": self.steps,
            "dt_s": self.settings.dt_s,
            "substeps": self.settings.substeps,
            "stiffness": self.stiffness,
            "sleeping": self.settings.sleeping,
            "scene": scene_to(&self.scene),
        })
    }

    /// # Errors
    /// What is missing, by its place.
    pub fn parse(text: &str) -> Result<Self, String> {
        let value: Value = serde_json::from_str(text).map_err(|error| format!("no JSON: {error}"))?;
        let whole =
            |name: &str| value[name].as_u64().ok_or_else(|| format!("{name}: expected a whole number"));
        let want = match value["want"].as_str() {
            Some("times") => Want::Times,
            Some("states") => Want::States,
            _ => return Err("want: expected \"times\" or \"states\"".to_owned()),
        };
        let settings = Settings {
            dt_s: number(&value["dt_s"], "dt_s")?,
            substeps: u32::try_from(whole("substeps")?).map_err(|error| format!("substeps: {error}"))?,
            sleeping: value["sleeping"].as_bool().unwrap_or(false),
            ..Settings::default()
        };
        Ok(Self {
            want,
            steps: usize::try_from(whole("steps")?).map_err(|error| format!("steps: {error}"))?,
            settings,
            stiffness: number(&value["stiffness"], "stiffness")?,
            scene: scene_from(&value["scene"])?,
        })
    }
}

fn scene_to(scene: &Scene) -> Value {
    let action = |action: &Action| match action.change {
        Change::SetPose(pose) => json!([action.time_s, action.entity, "pose", pose_to(&pose)]),
        Change::SetVelocity(velocity) => {
            json!([action.time_s, action.entity, "velocity", velocity_to(&velocity)])
        }
    };
    json!({
        "name": scene.name,
        "gravity": scene.gravity,
        "entities": scene.entities.iter().map(entity_to).collect::<Vec<_>>(),
        "actions": scene.actions.iter().map(action).collect::<Vec<_>>(),
        "pairs": scene.pairs.iter().map(|p| json!([p.between, p.friction, p.restitution])).collect::<Vec<_>>(),
    })
}

fn entity_to(entity: &Entity) -> Value {
    let mass = match entity.motion {
        Motion::Static => Value::Null,
        Motion::Dynamic(mass) => json!([mass.mass_kg, mass.inertia_kg_m2]),
    };
    let child = |child: &ChildShape| {
        let Surface { friction, restitution, material, .. } = child.surface;
        json!([pose_to(&child.body_from_shape), [friction, restitution], material, shape_to(&child.shape)])
    };
    let shapes: Vec<Value> = entity.shapes.iter().map(child).collect();
    json!({ "mass": mass, "pose": pose_to(&entity.pose), "velocity": velocity_to(&entity.velocity), "shapes": shapes })
}

fn pose_to(pose: &Pose) -> Value {
    json!([pose.position, pose.rotation])
}

fn velocity_to(velocity: &Velocity) -> Value {
    json!([velocity.linear, velocity.angular])
}

fn shape_to(shape: &Shape) -> Value {
    match shape {
        Shape::Sphere { radius } => json!(["sphere", radius]),
        Shape::Box { half_extents } => json!(["box", half_extents]),
        Shape::Capsule { half_height, radius } => json!(["capsule", half_height, radius]),
        Shape::Cylinder { half_height, radius } => json!(["cylinder", half_height, radius]),
        Shape::Cone { half_height, radius } => json!(["cone", half_height, radius]),
        Shape::Hull { points } => json!(["hull", points]),
        Shape::HalfSpace => json!(["half-space"]),
        Shape::TriangleMesh { positions, triangles } => json!(["mesh", positions, triangles]),
        Shape::HeightField(field) => json!(["heights", field.heights, field.columns, field.spacing]),
    }
}

fn number(value: &Value, place: &str) -> Result<f64, String> {
    value.as_f64().ok_or_else(|| format!("{place}: expected a number, found {value}"))
}

fn numbers<const N: usize>(value: &Value, place: &str) -> Result<[f64; N], String> {
    let found = value.as_array().map(|all| all.iter().filter_map(Value::as_f64).collect::<Vec<_>>());
    found
        .and_then(|all| all.try_into().ok())
        .ok_or_else(|| format!("{place}: expected {N} numbers, found {value}"))
}

fn list<'a>(value: &'a Value, place: &str) -> Result<&'a Vec<Value>, String> {
    value.as_array().ok_or_else(|| format!("{place}: expected a list, found {value}"))
}

fn scene_from(value: &Value) -> Result<Scene, String> {
    let entity = |(i, value): (usize, &Value)| entity_from(value, &format!("entity {i}"));
    let action = |value: &Value| -> Result<Action, String> {
        let change = match value[2].as_str() {
            Some("pose") => Change::SetPose(pose_from(&value[3], "an action's pose")?),
            _ => Change::SetVelocity(velocity_from(&value[3], "an action's velocity")?),
        };
        let entity = value[1].as_u64().and_then(|entity| usize::try_from(entity).ok());
        Ok(Action {
            time_s: number(&value[0], "an action's time")?,
            entity: entity.ok_or("an action's entity: expected a whole number")?,
            change,
        })
    };
    let pair = |value: &Value| -> Result<MaterialPair, String> {
        let [Some(one), Some(other)] = [material(&value[0][0]), material(&value[0][1])] else {
            return Err(format!("a pair of materials: expected two whole numbers, found {}", value[0]));
        };
        Ok(MaterialPair {
            between: [one, other],
            friction: value[1].as_f64(),
            restitution: value[2].as_f64(),
        })
    };
    Ok(Scene {
        name: value["name"].as_str().unwrap_or_default().to_owned(),
        gravity: numbers(&value["gravity"], "gravity")?,
        entities: list(&value["entities"], "entities")?
            .iter()
            .enumerate()
            .map(entity)
            .collect::<Result<_, _>>()?,
        actions: list(&value["actions"], "actions")?.iter().map(action).collect::<Result<_, _>>()?,
        pairs: list(&value["pairs"], "pairs")?.iter().map(pair).collect::<Result<_, _>>()?,
    })
}

fn material(value: &Value) -> Option<u32> {
    value.as_u64().and_then(|material| u32::try_from(material).ok())
}

fn entity_from(value: &Value, place: &str) -> Result<Entity, String> {
    let mass = &value["mass"];
    let motion = if mass.is_null() {
        Motion::Static
    } else {
        Motion::Dynamic(Mass { mass_kg: number(&mass[0], place)?, inertia_kg_m2: numbers(&mass[1], place)? })
    };
    let child = |value: &Value| -> Result<ChildShape, String> {
        Ok(ChildShape {
            shape: shape_from(&value[3], place)?,
            body_from_shape: pose_from(&value[0], place)?,
            surface: {
                let [friction, restitution] = numbers(&value[1], place)?;
                Surface { material: material(&value[2]), ..Surface::new(friction, restitution) }
            },
            part: 0,
        })
    };
    Ok(Entity {
        name: place.to_owned(),
        motion,
        pose: pose_from(&value["pose"], place)?,
        velocity: velocity_from(&value["velocity"], place)?,
        shapes: list(&value["shapes"], place)?.iter().map(child).collect::<Result<_, _>>()?,
    })
}

fn pose_from(value: &Value, place: &str) -> Result<Pose, String> {
    Ok(Pose { position: numbers(&value[0], place)?, rotation: numbers(&value[1], place)? })
}

fn velocity_from(value: &Value, place: &str) -> Result<Velocity, String> {
    Ok(Velocity { linear: numbers(&value[0], place)?, angular: numbers(&value[1], place)? })
}

fn shape_from(value: &Value, place: &str) -> Result<Shape, String> {
    let of = |index: usize| number(&value[index], place);
    let points = |value: &Value| -> Result<Vec<[f64; 3]>, String> {
        list(value, place)?.iter().map(|point| numbers(point, place)).collect()
    };
    Ok(match value[0].as_str() {
        Some("sphere") => Shape::Sphere { radius: of(1)? },
        Some("box") => Shape::Box { half_extents: numbers(&value[1], place)? },
        Some("capsule") => Shape::Capsule { half_height: of(1)?, radius: of(2)? },
        Some("cylinder") => Shape::Cylinder { half_height: of(1)?, radius: of(2)? },
        Some("cone") => Shape::Cone { half_height: of(1)?, radius: of(2)? },
        Some("hull") => Shape::Hull { points: points(&value[1])? },
        Some("half-space") => Shape::HalfSpace,
        Some("mesh") => {
            let index = |value: &Value| value.as_u64().and_then(|i| u32::try_from(i).ok());
            let triangle = |value: &Value| {
                let corners: Vec<u32> = list(value, place)?.iter().filter_map(index).collect();
                corners.try_into().map_err(|_| format!("{place}: expected three indices, found {value}"))
            };
            let triangles = list(&value[2], place)?.iter().map(triangle).collect::<Result<_, String>>()?;
            Shape::TriangleMesh { positions: points(&value[1])?, triangles }
        }
        Some("heights") => {
            let heights = list(&value[1], place)?
                .iter()
                .map(|height| number(height, place))
                .collect::<Result<_, _>>()?;
            let columns = value[2].as_u64().and_then(|count| u32::try_from(count).ok()).unwrap_or(0);
            Shape::HeightField(HeightField { heights, columns, spacing: numbers(&value[3], place)? })
        }
        _ => return Err(format!("{place}: unknown shape {}", value[0])),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[allow(clippy::expect_used, reason = "a test may stop at the first surprise")]
    fn a_request_survives_the_way_there() {
        for name in ["seed-8f", "seed-8g", "heap", "h13-mesh", "h18-ring", "micro-box"] {
            let exhibit = sim::gallery::by_name(name).expect("in the gallery");
            let mut scene = (exhibit.scene)();
            for (i, entity) in scene.entities.iter_mut().enumerate() {
                entity.name = format!("entity {i}");
                entity.shapes[0].surface.material = u32::try_from(i).ok();
            }
            scene.pairs.push(MaterialPair { between: [0, 1], friction: Some(0.25), restitution: None });
            let settings =
                Settings { dt_s: 1.0 / 148.0, substeps: 3, sleeping: false, ..Settings::default() };
            let request = Request { want: Want::States, steps: 7, settings, stiffness: 4.0, scene };
            let back = Request::parse(&request.to_json().to_string()).expect("read back");
            assert!(back == request, "{name} came back another");
        }
    }

    #[test]
    fn what_is_missing_is_named() {
        assert_eq!(Request::parse("{}"), Err("want: expected \"times\" or \"states\"".to_owned()));
        assert!(Request::parse("no").is_err_and(|reason| reason.starts_with("no JSON")));
    }
}
