//! Every pose of every step as CSV.

use std::io::{self, BufWriter, Write};

use sim::{Frame, FrameSink, Scene, Settings, SleepState};

/// The first line of the file.
pub const HEADER: &str = "step,time,entity,px,py,pz,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz,sleeping";

/// Significant digits of every number.
const DIGITS: usize = 12;

/// Writes a row an entity and step, the start being step 0: s, m, quaternion `x y z w`, m/s, rad/s, world frame,
/// of the body's frame, whose origin is the centre of mass; `sleeping` is 1 for a body that sleeps and for one that never moves, else 0.
pub struct PosesSink<W: Write> {
    out: BufWriter<W>,
    names: Vec<String>,
    /// A static body is reported as sleeping: nothing about it changes.
    fixed: Vec<bool>,
    fault: Option<io::Error>,
}

impl<W: Write> PosesSink<W> {
    pub fn new(out: W) -> Self {
        Self {
            out: BufWriter::with_capacity(1 << 16, out),
            names: Vec::new(),
            fixed: Vec::new(),
            fault: None,
        }
    }

    /// The first error met while writing: a sink cannot return one when it happens.
    ///
    /// # Errors
    /// The file could not be written.
    pub fn finish(mut self) -> io::Result<()> {
        match self.fault.take() {
            Some(fault) => Err(fault),
            None => self.out.flush(),
        }
    }

    fn write(&mut self, frame: &Frame<'_>) -> io::Result<()> {
        let Some(rigid) = frame.rigid else { return Ok(()) };
        for (index, name) in self.names.iter().enumerate() {
            let (pose, velocity) = (&rigid.poses[index], &rigid.velocities[index]);
            write!(self.out, "{},{},{name}", frame.step, digits(frame.time_s))?;
            for value in [&pose.position[..], &pose.rotation, &velocity.linear, &velocity.angular].concat() {
                write!(self.out, ",{}", digits(value))?;
            }
            let sleeping = self.fixed[index] || rigid.sleep[index] == SleepState::Asleep;
            writeln!(self.out, ",{}", u8::from(sleeping))?;
        }
        Ok(())
    }
}

impl<W: Write> FrameSink for PosesSink<W> {
    fn begin(&mut self, scene: &Scene, _: &Settings) {
        self.names = scene.entities.iter().map(|entity| quoted(&entity.name)).collect();
        self.fixed = scene.entities.iter().map(|entity| entity.motion == sim::Motion::Static).collect();
        self.fault = writeln!(self.out, "{HEADER}").err();
    }

    fn frame(&mut self, frame: &Frame<'_>) {
        if self.fault.is_none() {
            self.fault = self.write(frame).err();
        }
    }

    fn end(&mut self) {
        if self.fault.is_none() {
            self.fault = self.out.flush().err();
        }
    }
}

/// `value` to [`DIGITS`] significant digits, the shortest way of writing them.
fn digits(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let scientific = format!("{value:.*e}", DIGITS - 1);
    let Some((mantissa, exponent)) = scientific.split_once('e') else { return scientific };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let trimmed = |text: &str| {
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }.to_owned()
    };
    if (-4..DIGITS as i32).contains(&exponent) {
        let decimals = (DIGITS as i32 - 1 - exponent).max(0) as usize;
        trimmed(&format!("{value:.decimals$}"))
    } else {
        format!("{}e{exponent}", trimmed(mantissa))
    }
}

/// A CSV field (RFC 4180).
pub fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use sim::{Entity, Motion, Pose, RigidBlock, Velocity};

    use super::*;

    #[test]
    fn numbers_carry_twelve_significant_digits() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (1.0 / 3.0, "0.333333333333"),
            (-2.0e4 / 3.0, "-6666.66666667"),
            (1.0 / 6.0e4, "1.66666666667e-5"),
            (1.0 / 6.0e9, "1.66666666667e-10"),
            (123_456_789_012_345.0, "1.23456789012e14"),
            (100.0, "100"),
        ];
        for (value, expected) in cases {
            assert_eq!(digits(value), expected);
        }
    }

    #[test]
    fn a_row_has_the_fields_of_the_header() {
        let entity = Entity {
            name: "a, \"b\"".to_owned(),
            motion: Motion::Static,
            pose: Pose::IDENTITY,
            velocity: Velocity::default(),
            shapes: Vec::new(),
        };
        let scene = Scene::new("", vec![entity]);
        let rigid = RigidBlock {
            poses: &[Pose::at([1.0, 2.5, -3.0])],
            velocities: &[Velocity::default()],
            sleep: &[SleepState::Active],
        };
        let frame = Frame {
            version: sim::FRAME_VERSION,
            step: 3,
            time_s: 0.05,
            rigid: Some(rigid),
            soft: None,
            fluid: None,
            contacts: None,
            events: &[],
            metrics: sim::Metrics::default(),
        };
        let mut bytes = Vec::new();
        let mut sink = PosesSink::new(&mut bytes);
        sink.begin(&scene, &Settings::default());
        sink.frame(&frame);
        sink.end();
        sink.finish().expect("a vector takes everything");
        let text = String::from_utf8(bytes).expect("UTF-8");
        assert_eq!(text, format!("{HEADER}\n3,0.05,\"a, \"\"b\"\"\",1,2.5,-3,0,0,0,1,0,0,0,0,0,0,1\n"));
    }
}
