//! Divides a batch over machines that know nothing of each other.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// One of `count` shares of the models, told apart by name alone: the same share on every machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    index: u32,
    count: u32,
}

impl Shard {
    /// All models.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Share `index` of `count`, counted from 0; `None` where there is no such share.
    #[must_use]
    pub const fn new(index: u32, count: u32) -> Option<Self> {
        if index < count { Some(Self { index, count }) } else { None }
    }

    /// Whether a model belongs to this share.
    #[must_use]
    pub fn holds(self, model: &str) -> bool {
        in_shard(model, self.index, self.count)
    }
}

/// As people write it, counted from 1: `2/8` is the second of eight.
impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.split_once('/')
            .and_then(|(number, count)| Some((number.trim().parse().ok()?, count.trim().parse().ok()?)))
            .and_then(|(number, count): (u32, u32)| Self::new(number.checked_sub(1)?, count))
            .ok_or_else(|| format!("expected I/N with I from 1 to N, as 2/8, found {text:?}"))
    }
}

/// Whether a model belongs to share `index` of `count`, counted from 0.
#[must_use]
pub fn in_shard(model: &str, index: u32, count: u32) -> bool {
    let hash = blake3::hash(model.as_bytes());
    let start = hash.as_bytes().first_chunk().copied().unwrap_or_default();
    u64::from_le_bytes(start).checked_rem(u64::from(count)) == Some(u64::from(index))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_model_is_in_one_shard_and_shards_are_even() {
        let mut sizes = [0; 7];
        for index in 0..7_000 {
            let model = format!("folder/model {index}.glb");
            let holders: Vec<u32> = (0..7).filter(|shard| in_shard(&model, *shard, 7)).collect();
            assert_eq!(holders.len(), 1);
            sizes[holders[0] as usize] += 1;
            assert!(Shard::WHOLE.holds(&model));
        }
        assert!(sizes.iter().all(|size| (850..1_150).contains(size)), "{sizes:?}");
    }

    /// Other machines must come to the same shares: this may never change.
    #[test]
    fn shares_are_fixed() {
        let shares: Vec<u32> = ["a.glb", "b/c.obj", "stühle/1.stl"]
            .iter()
            .filter_map(|model| (0..10).find(|index| in_shard(model, *index, 10)))
            .collect();
        assert_eq!(shares, [5, 1, 2]);
    }

    #[test]
    fn there_is_no_shard_beyond_the_last() {
        assert_eq!(Shard::new(3, 3), None);
        assert_eq!(Shard::new(0, 0), None);
        for wrong in ["0/3", "4/3", "1", "a/b", "1/0", "-1/3", "1/3/3"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
        assert_eq!("3/3".parse::<Shard>().ok(), Shard::new(2, 3));
        assert!(!in_shard("a", 0, 0));
    }
}
