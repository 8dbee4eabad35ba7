//! What an entry of a file says and where it says it, as two hashes: so that a change can be told from a move.

use crate::text::yaml::{Data, Node};

/// Fingerprint of one entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Print {
    /// Of every key and value, in order.
    pub content: [u8; 32],
    /// Of their lines and columns.
    pub places: [u8; 32],
}

impl Print {
    /// Of several nodes that make one entry; below a map at the top of one the key `skip` is left out.
    #[must_use]
    pub fn of(nodes: &[&Node], skip: &str) -> Self {
        let mut walk = Walk { content: blake3::Hasher::new(), places: blake3::Hasher::new() };
        for node in nodes {
            walk.node(node, skip);
        }
        Self { content: *walk.content.finalize().as_bytes(), places: *walk.places.finalize().as_bytes() }
    }
}

struct Walk {
    content: blake3::Hasher,
    places: blake3::Hasher,
}

impl Walk {
    fn node(&mut self, node: &Node, skip: &str) {
        match &node.data {
            Data::Scalar { text, .. } => {
                self.content.update(&[0]).update(&(text.len() as u64).to_le_bytes()).update(text.as_bytes());
                self.places.update(&node.span.line.to_le_bytes()).update(&node.span.column.to_le_bytes());
            }
            Data::List(items) => {
                self.content.update(&[1]);
                items.iter().for_each(|item| self.node(item, ""));
            }
            Data::Map(pairs) => {
                self.content.update(&[2]);
                for (key, value) in pairs.iter().filter(|(key, _)| key.text() != skip) {
                    self.node(key, "");
                    self.node(value, "");
                }
            }
        }
        // An end, so that no nesting can pass for another.
        self.content.update(&[3]);
    }
}
