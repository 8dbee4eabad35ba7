//! Every tunable of the solver, with its unit, its reason and its range.

use crate::error::SceneError;

/// What the contact solver computes in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// f32, eight lanes: velocities, and displacements since the step began. Positions and flight are f64 either way.
    #[default]
    Single,
    /// f64, the same kernels: the reference that shows what single precision costs.
    Double,
}

/// How a world is stepped. The defaults are meant for every scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// s. Length of a step; 1/60 is the display's. Range (0, 1/20].
    pub dt_s: f64,
    /// Small steps a step: error falls faster with them than with iterations (Macklin et al. 2019). Range 1 to 64.
    pub substeps: u32,
    /// Whether still bodies may fall asleep.
    pub sleeping: bool,
    /// Hz. Stiffness of a soft contact as a spring of this frequency on the pair's effective mass; capped at a
    /// quarter of the substep rate, above which the spring is not resolved.
    pub contact_hertz: f64,
    /// Damping ratio of the same spring: above 1, so that pushing apart never overshoots.
    pub contact_damping_ratio: f64,
    /// m/s. Fastest that an overlap is pushed apart, so that a start inside a wall is no explosion.
    pub max_push_speed_m_s: f64,
    /// Share of a shape's inner radius by which two shapes may have moved against each other while their contact points are
    /// kept as they are: the error of a point's place. 0 finds them anew in every step. What rolls always does. Range
    /// 0 to 0.01.
    pub contact_keep_share: f64,
    /// s. How long an island must be still before it sleeps.
    pub sleep_delay_s: f64,
    pub precision: Precision,
    /// Whether the kernels of this processor may be used where it has them; the same bits without.
    pub simd: bool,
    /// Workers of a step; the same bits for any number. Range 1 to 64.
    pub threads: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            dt_s: 1.0 / 60.0,
            substeps: 8,
            sleeping: true,
            contact_hertz: 60.0,
            contact_damping_ratio: 5.0,
            max_push_speed_m_s: 3.0,
            contact_keep_share: 2e-4,
            sleep_delay_s: 0.5,
            precision: Precision::Single,
            simd: true,
            threads: 1,
        }
    }
}

impl Settings {
    /// # Errors
    /// [`SceneError::Setting`] for the first value outside its range.
    pub fn check(&self) -> Result<(), SceneError> {
        let within = |name, value: f64, good: bool, range| {
            if good { Ok(()) } else { Err(SceneError::Setting { name, value, range }) }
        };
        let positive = |x: f64| x > 0.0 && x.is_finite();
        within("dt_s", self.dt_s, positive(self.dt_s) && self.dt_s <= 0.05, "above 0 and at most 0.05 s")?;
        within(
            "substeps",
            f64::from(self.substeps),
            (1..=64).contains(&self.substeps),
            "a whole number from 1 to 64",
        )?;
        within(
            "threads",
            f64::from(self.threads),
            (1..=64).contains(&self.threads),
            "a whole number from 1 to 64",
        )?;
        within("contact_hertz", self.contact_hertz, positive(self.contact_hertz), "above 0 Hz")?;
        within(
            "contact_damping_ratio",
            self.contact_damping_ratio,
            positive(self.contact_damping_ratio),
            "above 0",
        )?;
        within(
            "max_push_speed_m_s",
            self.max_push_speed_m_s,
            positive(self.max_push_speed_m_s),
            "above 0 m/s",
        )?;
        within(
            "contact_keep_share",
            self.contact_keep_share,
            (0.0..=0.01).contains(&self.contact_keep_share),
            "0 to 0.01",
        )?;
        within("sleep_delay_s", self.sleep_delay_s, positive(self.sleep_delay_s), "above 0 s")
    }
}
