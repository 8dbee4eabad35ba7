//! The contact cache of a pair, gone through in the order of its child shapes while it is brought up to date.

use crate::collide::manifold::Manifold;
use crate::collide::pair::{Memory, Pair};

/// A pair's cache while its child shapes are gone through in the order of their keys: what was passed over is dropped.
pub(crate) struct Cache<'a> {
    pair: &'a mut Pair,
    manifold: usize,
    memory: usize,
}

impl<'a> Cache<'a> {
    /// Of a pair whose child shapes are gone through from the first.
    pub(crate) fn new(pair: &'a mut Pair) -> Self {
        Self { pair, manifold: 0, memory: 0 }
    }

    /// Drops what has not been moved past.
    pub(crate) fn end(self) {
        self.pair.manifolds.truncate(self.manifold);
        self.pair.memories.truncate(self.memory);
    }

    /// Takes the memory of `key` out of the cache; [`Cache::remember`] puts it back.
    pub(crate) fn recall(&mut self, key: (u32, u32)) -> Memory {
        let memories = &mut self.pair.memories;
        while memories.get(self.memory).is_some_and(|memory| memory.key < key) {
            memories.remove(self.memory);
        }
        match memories.get(self.memory) {
            Some(memory) if memory.key == key => memory.clone(),
            _ => {
                memories.insert(self.memory, Memory { key, ..Memory::default() });
                memories[self.memory].clone()
            }
        }
    }

    /// Empties the memory of `key`, the one to come next or the one just put back.
    pub(crate) fn forget(&mut self, key: (u32, u32)) {
        for at in [self.memory, self.memory.wrapping_sub(1)] {
            if let Some(memory) = self.pair.memories.get_mut(at).filter(|memory| memory.key == key) {
                *memory = Memory { key, ..Memory::default() };
            }
        }
    }

    pub(crate) fn remember(&mut self, memory: Memory) {
        self.pair.memories[self.memory] = memory;
        self.memory += 1;
    }

    /// The manifold of `key` if there is one, moved past.
    pub(crate) fn keep(&mut self, key: (u32, u32, u32)) -> Option<&mut Manifold> {
        let manifolds = &mut self.pair.manifolds;
        while manifolds.get(self.manifold).is_some_and(|manifold| manifold.key < key) {
            manifolds.remove(self.manifold);
        }
        let found = manifolds.get_mut(self.manifold).filter(|manifold| manifold.key == key)?;
        self.manifold += 1;
        Some(found)
    }

    /// Manifolds of two child shapes that have not been moved past.
    pub(crate) fn left(&self, (i, j): (u32, u32)) -> impl Iterator<Item = &Manifold> {
        let left = self.pair.manifolds[self.manifold..].iter();
        left.skip_while(move |manifold| manifold.key < (i, j, 0))
            .take_while(move |manifold| (manifold.key.0, manifold.key.1) == (i, j))
    }

    /// Moves past all manifolds of two child shapes.
    pub(crate) fn keep_all(&mut self, (i, j): (u32, u32)) {
        let manifolds = &mut self.pair.manifolds;
        while manifolds.get(self.manifold).is_some_and(|manifold| manifold.key < (i, j, 0)) {
            manifolds.remove(self.manifold);
        }
        while manifolds.get(self.manifold).is_some_and(|manifold| (manifold.key.0, manifold.key.1) == (i, j))
        {
            self.manifold += 1;
        }
    }

    /// Drops the manifolds of two child shapes that have not been moved past.
    pub(crate) fn drop_left(&mut self, (i, j): (u32, u32)) {
        let manifolds = &mut self.pair.manifolds;
        while manifolds.get(self.manifold).is_some_and(|m| (m.key.0, m.key.1) <= (i, j)) {
            manifolds.remove(self.manifold);
        }
    }

    /// The manifold of `key`, an empty one if it is new.
    pub(crate) fn entry(&mut self, key: (u32, u32, u32)) -> &mut Manifold {
        if self.keep(key).is_none() {
            self.pair.manifolds.insert(self.manifold, Manifold { key, ..Manifold::default() });
            self.manifold += 1;
        }
        &mut self.pair.manifolds[self.manifold - 1]
    }
}
