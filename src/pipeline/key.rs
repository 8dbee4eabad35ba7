//! Input keys: everything that a stage's result depends on, as one hash.

/// Part of every key: raise it when a stage's code would give another result on the same input.
const VERSION: &str = concat!("physique ", env!("CARGO_PKG_VERSION"), " stages 8");

/// Collects what a result depends on. Fields are told apart by their lengths, so that none can pass for another.
pub struct Key(blake3::Hasher);

impl Key {
    #[must_use]
    pub fn new(stage: &str) -> Self {
        Self(blake3::Hasher::new()).with(VERSION).with(stage)
    }

    #[must_use]
    pub fn with(mut self, field: impl AsRef<[u8]>) -> Self {
        let field = field.as_ref();
        self.0.update(&(field.len() as u64).to_le_bytes()).update(field);
        self
    }

    /// 64 hexadecimal digits.
    #[must_use]
    pub fn finish(self) -> String {
        self.0.finalize().to_hex().to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_do_not_run_into_each_other() {
        assert_ne!(
            Key::new("map").with("ab").with("c").finish(),
            Key::new("map").with("a").with("bc").finish()
        );
        assert_ne!(Key::new("map").with("").finish(), Key::new("map").finish());
        assert_eq!(Key::new("map").with("x").finish(), Key::new("map").with("x").finish());
    }
}
