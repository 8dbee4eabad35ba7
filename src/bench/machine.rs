//! On what was measured.

use std::fs;
use std::process::Command;
use std::thread;

use serde::Serialize;

use super::engine::Programs;

/// Machine, versions and flags.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    pub processor: String,
    pub cores: usize,
    /// GiB
    pub memory_gib: f64,
    pub system: String,
    /// Load over the last minute as the report began; absent where the system does not tell.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load: Option<f64>,
    pub physique: String,
    pub rapier: String,
    /// What rapier's other build says of itself, or why there is none.
    pub rapier_simd8: String,
    /// Of this build.
    pub flags: String,
}

impl Machine {
    #[must_use]
    pub fn here(programs: &Programs) -> Self {
        let cpuinfo = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let field = |text: &str, name: &str| {
            let line = text.lines().find(|line| line.starts_with(name))?;
            Some(line.split_once(':')?.1.trim().to_owned())
        };
        let memory = fs::read_to_string("/proc/meminfo").unwrap_or_default();
        let kib = field(&memory, "MemTotal").and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
        let load = fs::read_to_string("/proc/loadavg").ok();
        Self {
            processor: field(&cpuinfo, "model name").unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
            cores: thread::available_parallelism().map_or(1, usize::from),
            memory_gib: kib.unwrap_or(0.0) / f64::from(1 << 20),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            load: load.and_then(|text| text.split(' ').next()?.parse().ok()),
            physique: env!("CARGO_PKG_VERSION").to_owned(),
            rapier: rapier(),
            rapier_simd8: simd8(programs),
            flags: flags(),
        }
    }

    pub(super) fn lines(&self) -> Vec<(&'static str, String)> {
        let load = self.load.map_or_else(String::new, |load| format!(", load {load} at the start"));
        vec![
            ("processor", format!("{}, {} cores{load}", self.processor, self.cores)),
            ("memory", format!("{:.0} GiB", self.memory_gib)),
            ("system", self.system.clone()),
            ("Physique", format!("{}, f64 state", self.physique)),
            ("rapier", self.rapier.clone()),
            ("rapier, eight lanes", self.rapier_simd8.clone()),
            ("build", self.flags.clone()),
        ]
    }
}

#[cfg(feature = "validate")]
fn rapier() -> String {
    baseline::version()
}

#[cfg(not(feature = "validate"))]
fn rapier() -> String {
    "not in this build".to_owned()
}

fn simd8(programs: &Programs) -> String {
    let Some(program) = &programs.simd8 else { return "not built; --build-simd8 builds it".to_owned() };
    match Command::new(program).arg("--version").output() {
        Ok(output) if output.status.success() => {
            format!("{}, AVX2 and FMA at compile time", String::from_utf8_lossy(&output.stdout).trim())
        }
        Ok(output) => format!("{} ended with {}", program.display(), output.status),
        Err(error) => format!("{}: {error}", program.display()),
    }
}

fn flags() -> String {
    let on = [
        ("avx2", cfg!(target_feature = "avx2")),
        ("fma", cfg!(target_feature = "fma")),
        ("sse4.1", cfg!(target_feature = "sse4.1")),
        ("debug assertions", cfg!(debug_assertions)),
    ];
    let on: Vec<&str> = on.iter().filter(|(_, on)| *on).map(|(name, _)| *name).collect();
    let on = if on.is_empty() { "the target's baseline".to_owned() } else { on.join(", ") };
    format!("{}; {on}", if cfg!(debug_assertions) { "dev profile" } else { "release profile" })
}
