//! The layout of the viewer: the scene on the left, numbers and text on the right.
//!
//! The builder of rerun 0.36 knows neither the eye nor the grid nor a hidden entity, so the blueprint's own store is
//! logged here. Ids are fixed, so that a viewer keeps a user's changes from run to run.

use rerun::external::re_log_types::BlueprintActivationCommand;
use rerun::external::re_sdk_types::blueprint::{archetypes as ba, components as bc};
use rerun::external::uuid::Uuid;
use rerun::{AsComponents, RecordingStream, RecordingStreamBuilder};

use crate::bounds::Bounds;
use crate::error::ViewerError;
use crate::palette;

/// Direction from the scene to the eye.
const FROM: [f32; 3] = [0.62, 0.46, 1.0];

/// Tangent of half the viewer's vertical angle of view, 55 degrees.
const HALF_VIEW_TAN: f32 = 0.5206;
/// Width over height of the view on a usual screen, and how much of it a scene fills.
const ASPECT: f32 = 1.2;
const FILL: f32 = 0.95;

/// A panel of the right column: its title and where its data lives.
#[derive(Clone, Debug)]
pub(crate) struct Panel {
    pub(crate) title: String,
    pub(crate) origin: String,
}

impl Panel {
    pub(crate) fn new(title: &str, origin: &str) -> Self {
        Self { title: title.to_owned(), origin: origin.to_owned() }
    }
}

/// What the layout shows.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub(crate) title: String,
    /// What the eye frames.
    pub(crate) bounds: Bounds,
    /// Height of the ground, which carries a grid for scale.
    pub(crate) floor: Option<f32>,
    /// Direction from the scene to the eye.
    pub(crate) from: [f32; 3],
    pub(crate) plots: Vec<Panel>,
    pub(crate) texts: Vec<Panel>,
    pub(crate) log: Option<Panel>,
    /// Entities that one click on an eye shows.
    pub(crate) hidden: Vec<String>,
    /// Follow the newest frame instead of waiting at the first.
    pub(crate) live: bool,
}

impl Layout {
    pub(crate) fn new(title: &str, bounds: Bounds, live: bool) -> Self {
        Self {
            title: title.to_owned(),
            bounds,
            floor: None,
            from: FROM,
            plots: Vec::new(),
            texts: Vec::new(),
            log: None,
            hidden: Vec::new(),
            live,
        }
    }

    /// Sends the layout to all sinks of `stream`.
    pub(crate) fn send(&self, stream: &RecordingStream) -> Result<(), ViewerError> {
        let Some(info) = stream.store_info() else { return Ok(()) };
        let app = info.store_id.application_id().clone();
        let (store, memory) = RecordingStreamBuilder::new(app)
            .recording_id("physique-blueprint")
            .blueprint()
            .memory()
            .map_err(ViewerError::encode)?;
        store.set_time_sequence("blueprint", 0);
        self.log(&Store(&store))?;
        let messages = memory.take();
        // The memory holds its stream and the stream the memory.
        store.disconnect();
        let Some(blueprint_id) = messages.first().map(|message| message.store_id().clone()) else {
            return Ok(());
        };
        let activate = BlueprintActivationCommand { blueprint_id, make_active: true, make_default: true };
        stream.send_blueprint(messages, activate);
        Ok(())
    }

    fn log(&self, store: &Store<'_>) -> Result<(), ViewerError> {
        let mut ids = 10u128..;
        let mut next = || Uuid::from_u128(ids.next().unwrap_or(0));
        let scene = self.scene(store)?;
        let mut column = Vec::new();
        for panel in &self.plots {
            let view = store.view(next(), "TimeSeries", panel)?;
            let legend = ba::PlotLegend::new().with_corner(bc::Corner2D::RightTop);
            store.log(&format!("{view}/PlotLegend"), &legend)?;
            column.push(view);
        }
        let mut tabs = Vec::new();
        for panel in &self.texts {
            tabs.push(store.view(next(), "TextDocument", panel)?);
        }
        if let Some(panel) = &self.log {
            tabs.push(store.view(next(), "TextLog", panel)?);
        }
        // Text needs about as much height as all plots together.
        let mut shares = vec![1.0; column.len()];
        if !tabs.is_empty() {
            shares.push(1.4);
            column.push(store.container(
                Uuid::from_u128(3),
                &ba::ContainerBlueprint::new(bc::ContainerKind::Tabs).with_contents(tabs),
            )?);
        }
        let right = ba::ContainerBlueprint::new(bc::ContainerKind::Vertical)
            .with_contents(column)
            .with_row_shares(shares);
        let right = store.container(Uuid::from_u128(2), &right)?;
        let root = Uuid::from_u128(1);
        let whole = ba::ContainerBlueprint::new(bc::ContainerKind::Horizontal)
            .with_contents([scene, right])
            .with_col_shares([2.6, 1.0]);
        store.container(root, &whole)?;
        let viewport = ba::ViewportBlueprint::new()
            .with_root_container(bc::RootContainer(root.into()))
            .with_auto_layout(false)
            .with_auto_views(false);
        store.log("viewport", &viewport)?;
        for panel in ["blueprint_panel", "selection_panel"] {
            store.log(panel, &ba::PanelBlueprint::new().with_state(bc::PanelState::Collapsed))?;
        }
        let play = if self.live { bc::PlayState::Following } else { bc::PlayState::Paused };
        let time = ba::TimePanelBlueprint::new()
            .with_state(bc::PanelState::Collapsed)
            .with_timeline("sim_time")
            .with_play_state(play);
        store.log("time_panel", &time)
    }

    fn scene(&self, store: &Store<'_>) -> Result<String, ViewerError> {
        let id = Uuid::from_u128(4);
        let view = store.view(id, "3D", &Panel::new(&self.title, "/world"))?;
        let radius = self.bounds.radius().max(1e-3);
        let (eye, target) = frame(&self.bounds, self.from);
        let controls = ba::EyeControls3D::new()
            .with_kind(bc::Eye3DKind::Orbital)
            .with_position(eye)
            .with_look_target(target)
            .with_eye_up([0.0, 1.0, 0.0]);
        store.log(&format!("{view}/EyeControls3D"), &controls)?;
        let mut grid = ba::LineGrid3D::new().with_visible(self.floor.is_some());
        if let Some(floor) = self.floor {
            // A little above the plate, on which it would flicker.
            grid = grid
                .with_plane(rerun::components::Plane3D::new([0.0, 1.0, 0.0], floor + 0.002 * radius))
                .with_spacing(spacing(radius))
                .with_stroke_width(1.0)
                .with_color(palette::color(palette::GRID));
        }
        store.log(&format!("{view}/LineGrid3D"), &grid)?;
        let back =
            ba::Background::new(bc::BackgroundKind::SolidColor).with_color(palette::color(palette::BACKDROP));
        store.log(&format!("{view}/Background"), &back)?;
        for entity in &self.hidden {
            let path = format!("{view}/ViewContents/overrides/{entity}/visualizers");
            store.log(&path, &ba::EntityBehavior::new().with_visible(false))?;
        }
        Ok(view)
    }
}

/// Eye and target such that the corners of `bounds` just fill the view, seen from direction `from`.
fn frame(bounds: &Bounds, from: [f32; 3]) -> ([f32; 3], [f32; 3]) {
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let along = |a: [f32; 3], t: f32, b: [f32; 3]| -> [f32; 3] { std::array::from_fn(|i| a[i] + t * b[i]) };
    let unit = |a: [f32; 3]| a.map(|x| x / dot(a, a).sqrt());
    let back = unit(from);
    let right = unit([back[2], 0.0, -back[0]]);
    let up = along([0.0, 1.0, 0.0], -back[1], back);
    let up = unit(up);
    let mut target = bounds.center();
    let mut distance = 3.0 * bounds.radius().max(1e-3);
    // Each round centres the picture and scales the distance; the perspective changes little from one to the next.
    for _ in 0..24 {
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        for i in 0..8u8 {
            let corner = [0, 1, 2].map(|k| if i >> k & 1 == 1 { bounds.max[k] } else { bounds.min[k] });
            let rel = along(corner, -1.0, target);
            let depth = (distance - dot(rel, back)).max(0.05 * distance);
            let place = [dot(rel, right) / ASPECT / depth, dot(rel, up) / depth];
            low = [low[0].min(place[0]), low[1].min(place[1])];
            high = [high[0].max(place[0]), high[1].max(place[1])];
        }
        if low.iter().chain(&high).any(|x| !x.is_finite()) {
            break;
        }
        target = along(target, ASPECT * distance * f32::midpoint(low[0], high[0]), right);
        target = along(target, distance * f32::midpoint(low[1], high[1]), up);
        let half = 0.5 * (high[0] - low[0]).max(high[1] - low[1]);
        distance *= (half / (FILL * HALF_VIEW_TAN)).clamp(0.5, 2.0);
    }
    (along(target, distance, back), target)
}

/// A power of ten, twice or five times it, about a third of the scene's radius.
fn spacing(radius: f32) -> f32 {
    let power = 10f32.powf((radius / 3.0).log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * power);
    steps.into_iter().rev().find(|step| *step <= radius / 2.0).unwrap_or(power)
}

/// The blueprint's store; every method hands back the path it logged to.
struct Store<'a>(&'a RecordingStream);

impl Store<'_> {
    fn log(&self, path: &str, what: &impl AsComponents) -> Result<(), ViewerError> {
        self.0.log(path, what).map_err(ViewerError::encode)
    }

    fn view(&self, id: Uuid, class: &str, panel: &Panel) -> Result<String, ViewerError> {
        let path = format!("view/{id}");
        let contents = ba::ViewContents::new([bc::QueryExpression("$origin/**".into())]);
        self.log(&format!("{path}/ViewContents"), &contents)?;
        let view = ba::ViewBlueprint::new(bc::ViewClass(class.into()))
            .with_display_name(rerun::components::Name(panel.title.as_str().into()))
            .with_space_origin(panel.origin.clone());
        self.log(&path, &view)?;
        Ok(path)
    }

    fn container(&self, id: Uuid, container: &ba::ContainerBlueprint) -> Result<String, ViewerError> {
        let path = format!("container/{id}");
        self.log(&path, container)?;
        Ok(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corners_fill_the_view_and_none_is_cut() {
        for (bounds, from) in [
            (Bounds { min: [-8.0, 0.0, -7.0], max: [8.0, 0.7, 7.0] }, [0.0, 1.0, 1.0]),
            (Bounds { min: [10.0, 5.0, -1.0], max: [10.1, 9.0, -0.9] }, FROM),
        ] {
            let (eye, target) = frame(&bounds, from);
            let rel = |p: [f32; 3]| -> [f32; 3] { std::array::from_fn(|i| p[i] - eye[i]) };
            let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let ahead = rel(target);
            let ahead = ahead.map(|x| x / dot(ahead, ahead).sqrt());
            let side = [-ahead[2], 0.0, ahead[0]];
            let side = side.map(|x| x / dot(side, side).sqrt());
            let up = [0, 1, 2].map(|i| f32::from(u8::from(i == 1)) - ahead[1] * ahead[i]);
            let up = up.map(|x| x / dot(up, up).sqrt());
            let mut most = 0.0f32;
            for i in 0..8u8 {
                let corner =
                    rel([0, 1, 2].map(|k| if i >> k & 1 == 1 { bounds.max[k] } else { bounds.min[k] }));
                let depth = dot(corner, ahead) * HALF_VIEW_TAN;
                most =
                    most.max((dot(corner, side) / depth / ASPECT).abs()).max((dot(corner, up) / depth).abs());
            }
            assert!((0.9..0.96).contains(&most), "{most}");
        }
    }

    #[test]
    fn the_grid_has_round_spacings() {
        for (radius, expected) in [(0.05, 0.02), (1.0, 0.5), (3.0, 1.0), (70.0, 20.0)] {
            assert!((spacing(radius) / expected - 1.0).abs() < 1e-5, "{radius}: {}", spacing(radius));
        }
    }
}
