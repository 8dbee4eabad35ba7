//! Entity paths out of names that may hold anything, each used once.

use std::collections::BTreeSet;

use rerun::{EntityPath, EntityPathPart};

/// `root/a/b/name` with each of the levels escaped; a `/` in a name opens a level.
pub(crate) fn join(root: &str, names: &[&str]) -> EntityPath {
    let parts = root.split('/').chain(names.iter().flat_map(|name| name.split('/')));
    EntityPath::new(parts.filter(|part| !part.is_empty()).map(EntityPathPart::new).collect())
}

/// Makes names of one scene differ: the second `crate` becomes `crate~2`.
#[derive(Default)]
pub(crate) struct Names(BTreeSet<String>);

impl Names {
    pub(crate) fn unique(&mut self, name: &str) -> String {
        let base = if name.trim().is_empty() { "unnamed" } else { name };
        let mut candidate = base.to_owned();
        let mut count = 1;
        while !self.0.insert(candidate.clone()) {
            count += 1;
            candidate = format!("{base}~{count}");
        }
        candidate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_used_once() {
        let mut names = Names::default();
        let given: Vec<String> = ["a", "a", "", "a~2", "a"].iter().map(|n| names.unique(n)).collect();
        assert_eq!(given, ["a", "a~2", "unnamed", "a~2~2", "a~3"]);
    }

    #[test]
    fn any_name_makes_a_path_of_known_depth() {
        let path = join("world/models", &["furniture/old chair", "a.glb"]);
        assert_eq!(path.len(), 5);
    }
}
