//! A collision shape with what the narrow phase asks of it, computed once.

use crate::collide::parry;
use crate::error::SceneError;
use crate::material::MaterialPair;
use crate::math::{Frame3, Vec3};
use crate::scene::{ChildShape, Shape as SceneShape, Surface};

/// What a shape is, for the narrow phase.
#[derive(Clone, Debug)]
pub(crate) enum Geometry {
    Sphere {
        radius: f64,
    },
    Capsule {
        half_height: f64,
        radius: f64,
    },
    Cylinder {
        half_height: f64,
        radius: f64,
    },
    /// A convex polyhedron (box or hull) by its corners.
    Polyhedron {
        corners: Vec<Vec3>,
    },
    HalfSpace,
    TriangleMesh,
}

/// One shape of a body.
#[derive(Clone)]
pub(crate) struct Collider {
    pub(crate) geometry: Geometry,
    pub(crate) parry: parry::Shape,
    pub(crate) body_from_shape: Frame3,
    pub(crate) surface: Surface,
    /// Those of the scene's pairs that this material belongs to.
    pub(crate) pairs: Vec<MaterialPair>,
    /// Half the smallest extent of the bounding box, m: what a tolerance may be a share of.
    pub(crate) inner_radius: f64,
    /// Largest distance of a point from the body's origin, m.
    pub(crate) reach: f64,
    half_extents: Vec3,
    center: Vec3,
}

/// An axis-aligned box in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Aabb {
    pub(crate) min: Vec3,
    pub(crate) max: Vec3,
}

impl Aabb {
    pub(crate) fn grown(self, margin: f64) -> Self {
        Self { min: self.min.add_scalar(-margin), max: self.max.add_scalar(margin) }
    }

    pub(crate) fn merged(self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.min[axis] <= other.max[axis] && other.min[axis] <= self.max[axis])
    }
}

impl Collider {
    /// # Errors
    /// [`SceneError::Shape`], [`SceneError::StaticOnly`] or [`SceneError::Surface`], naming entity and shape.
    pub(crate) fn new(
        child: &ChildShape,
        entity: &str,
        index: usize,
        is_static: bool,
    ) -> Result<Self, SceneError> {
        let fault = |fault: String| SceneError::Shape { entity: entity.to_owned(), shape: index, fault };
        let static_only = |kind| SceneError::StaticOnly { entity: entity.to_owned(), shape: index, kind };
        let positive = |what: &str, value: f64| {
            if value > 0.0 && value.is_finite() {
                Ok(value)
            } else {
                Err(fault(format!("{what} is {value} m; expected a finite number above 0")))
            }
        };
        check_surface(&child.surface, entity, index)?;
        let (geometry, min, max) = match &child.shape {
            SceneShape::Sphere { radius } => {
                let radius = positive("radius", *radius)?;
                (Geometry::Sphere { radius }, Vec3::repeat(-radius), Vec3::repeat(radius))
            }
            SceneShape::Box { half_extents } => {
                for half in half_extents {
                    positive("a half extent", *half)?;
                }
                let half = Vec3::from(*half_extents);
                let corners = (0..8).map(|i| {
                    Vec3::from_fn(|axis, _| if i >> axis & 1 == 1 { half[axis] } else { -half[axis] })
                });
                (Geometry::Polyhedron { corners: corners.collect() }, -half, half)
            }
            SceneShape::Capsule { half_height, radius } => {
                let (half_height, radius) =
                    (positive("half height", *half_height)?, positive("radius", *radius)?);
                let half = Vec3::new(radius, half_height + radius, radius);
                (Geometry::Capsule { half_height, radius }, -half, half)
            }
            SceneShape::Cylinder { half_height, radius } => {
                let (half_height, radius) =
                    (positive("half height", *half_height)?, positive("radius", *radius)?);
                let half = Vec3::new(radius, half_height, radius);
                (Geometry::Cylinder { half_height, radius }, -half, half)
            }
            SceneShape::Hull { points } => {
                let corners: Vec<Vec3> = points.iter().map(|point| Vec3::from(*point)).collect();
                if corners.iter().any(|corner| !corner.iter().all(|x| x.is_finite())) {
                    return Err(fault("a hull point is not finite".to_owned()));
                }
                let (min, max) = bounds(&corners)
                    .ok_or_else(|| fault("a hull of no points; expected four or more".to_owned()))?;
                (Geometry::Polyhedron { corners }, min, max)
            }
            SceneShape::HalfSpace if is_static => {
                let far = 1e9;
                (Geometry::HalfSpace, Vec3::new(-far, -far, -far), Vec3::new(far, 0.0, far))
            }
            SceneShape::HalfSpace => return Err(static_only("half-space")),
            SceneShape::TriangleMesh { positions, .. } if is_static => {
                let positions: Vec<Vec3> = positions.iter().map(|point| Vec3::from(*point)).collect();
                let (min, max) =
                    bounds(&positions).ok_or_else(|| fault("a mesh of no vertices".to_owned()))?;
                (Geometry::TriangleMesh, min, max)
            }
            SceneShape::TriangleMesh { .. } => return Err(static_only("triangle mesh")),
        };
        let parry = parry::Shape::new(&child.shape).map_err(fault)?;
        let geometry = match (geometry, parry.hull_corners()) {
            // Points inside the hull would only cost time: keep its corners.
            (Geometry::Polyhedron { .. }, Some(corners)) => Geometry::Polyhedron { corners },
            (geometry, _) => geometry,
        };
        let half_extents = (max - min) * 0.5;
        let center = (max + min) * 0.5;
        let body_from_shape = Frame3::from(&child.body_from_shape);
        Ok(Self {
            geometry,
            parry,
            body_from_shape,
            surface: child.surface,
            pairs: Vec::new(),
            inner_radius: half_extents.min(),
            reach: body_from_shape.position.norm() + center.norm() + half_extents.norm(),
            half_extents,
            center,
        })
    }

    /// Keeps what the scene's pairs say of this material.
    pub(crate) fn learn(&mut self, pairs: &[MaterialPair]) {
        let own = pairs
            .iter()
            .filter(|pair| self.surface.material.is_some_and(|material| pair.between.contains(&material)));
        self.pairs = own.copied().collect();
    }

    /// Bounds in the world of the shape at `world_from_shape`.
    pub(crate) fn aabb(&self, world_from_shape: &Frame3) -> Aabb {
        let center = world_from_shape.point(&self.center);
        let half = match &self.geometry {
            Geometry::HalfSpace => Vec3::repeat(1e9),
            Geometry::Sphere { radius } => Vec3::repeat(*radius),
            _ => world_from_shape.rotation.to_rotation_matrix().matrix().abs() * self.half_extents,
        };
        Aabb { min: center - half, max: center + half }
    }
}

fn bounds(points: &[Vec3]) -> Option<(Vec3, Vec3)> {
    let first = points.first()?;
    Some(points.iter().fold((*first, *first), |(min, max), point| (min.inf(point), max.sup(point))))
}

fn check_surface(surface: &Surface, entity: &str, shape: usize) -> Result<(), SceneError> {
    let wrong = |what, value, range| {
        Err(SceneError::Surface { entity: entity.to_owned(), shape, what, value, range })
    };
    if !(surface.friction >= 0.0 && surface.friction.is_finite()) {
        return wrong("friction", surface.friction, "0 or more");
    }
    if !(0.0..=1.0).contains(&surface.restitution) {
        return wrong("restitution", surface.restitution, "0 to 1");
    }
    if !(surface.rolling_resistance >= 0.0 && surface.rolling_resistance.is_finite()) {
        return wrong("rolling resistance", surface.rolling_resistance, "0 or more");
    }
    Ok(())
}
