//! rapier's other build, in a process of its own.

use std::io::{BufReader, Read, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};

use baseline::wire::{NUMBERS, Request, Want};
use sim::{Pose, Scene, Velocity};

use super::engine::{Programs, Setup};
use super::running::{Running, Touch};

/// A scene under way there. Its states are read as they come.
pub(super) struct Remote {
    child: Child,
    out: BufReader<ChildStdout>,
    poses: Vec<Pose>,
    velocities: Vec<Velocity>,
}

fn start(
    want: Want,
    setup: &Setup,
    scene: &Scene,
    steps: usize,
    programs: &Programs,
) -> Result<(Child, BufReader<ChildStdout>), String> {
    let program: &Path =
        programs.simd8.as_deref().ok_or("its program is not there; --build-simd8 builds it")?;
    let gone = |error: std::io::Error| format!("{}: {error}", program.display());
    let mut child = Command::new(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::inherit())
        .spawn()
        .map_err(gone)?;
    let request =
        Request { want, steps, settings: setup.settings(), stiffness: setup.stiffness, scene: scene.clone() };
    if let Some(mut stdin) = child.stdin.take() {
        stdin.write_all(request.to_json().to_string().as_bytes()).map_err(gone)?;
    }
    let out = child.stdout.take().ok_or("it has no output")?;
    Ok((child, BufReader::with_capacity(1 << 20, out)))
}

/// ms of CPU of every step there.
///
/// # Errors
/// The program is not there, or refuses the scene.
pub(super) fn step_times(
    setup: &Setup,
    scene: &Scene,
    steps: usize,
    programs: &Programs,
) -> Result<Vec<f64>, String> {
    let (mut child, mut out) = start(Want::Times, setup, scene, steps, programs)?;
    let mut bytes = Vec::new();
    out.read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    let status = child.wait().map_err(|error| error.to_string())?;
    let times: Vec<f64> = bytes.chunks_exact(8).map(number).collect();
    if status.success() && times.len() == steps {
        Ok(times)
    } else {
        Err(format!("its program ended with {status} after {} steps", times.len()))
    }
}

fn number(bytes: &[u8]) -> f64 {
    f64::from_le_bytes(std::array::from_fn(|i| bytes[i]))
}

impl Remote {
    pub(super) fn states(
        setup: &Setup,
        scene: &Scene,
        steps: usize,
        programs: &Programs,
    ) -> Result<Self, String> {
        let (child, out) = start(Want::States, setup, scene, steps, programs)?;
        Ok(Self {
            child,
            out,
            poses: scene.entities.iter().map(|entity| entity.pose).collect(),
            velocities: scene.entities.iter().map(|entity| entity.velocity).collect(),
        })
    }
}

impl Running for Remote {
    fn advance(&mut self) -> Result<bool, String> {
        let mut bytes = vec![0; 1 + 8 * NUMBERS * self.poses.len()];
        self.out.read_exact(&mut bytes).map_err(|error| format!("its program ended early: {error}"))?;
        for ((chunk, pose), velocity) in
            bytes[1..].chunks_exact(8 * NUMBERS).zip(&mut self.poses).zip(&mut self.velocities)
        {
            let numbers: Vec<f64> = chunk.chunks_exact(8).map(number).collect();
            pose.position = std::array::from_fn(|i| numbers[i]);
            pose.rotation = std::array::from_fn(|i| numbers[3 + i]);
            velocity.linear = std::array::from_fn(|i| numbers[7 + i]);
            velocity.angular = std::array::from_fn(|i| numbers[10 + i]);
        }
        Ok(bytes[0] != 0)
    }

    fn state(&self) -> (Vec<Pose>, Vec<Velocity>) {
        (self.poses.clone(), self.velocities.clone())
    }

    fn touches(&self) -> Vec<Touch> {
        Vec::new()
    }
}

impl Drop for Remote {
    fn drop(&mut self) {
        // It ends by itself once nobody reads; a child that was not waited for would stay in the process table.
        drop(self.child.kill());
        drop(self.child.wait());
    }
}
