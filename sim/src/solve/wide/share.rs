//! A slice that several workers write at once, each its own elements.
#![allow(
    unsafe_code,
    reason = "with the SIMD files the only place: colours keep workers off each other's elements"
)]

use std::marker::PhantomData;
use std::ops::Range;

/// A mutable slice that can be handed to every worker of a step.
///
/// Which element belongs to whom is the graph colouring's promise: within a colour no two blocks name the same
/// body, and workers meet at a barrier between colours.
pub(crate) struct Shared<'a, T> {
    pointer: *mut T,
    len: usize,
    borrow: PhantomData<&'a mut [T]>,
}

// SAFETY: the accessors' callers promise that no two threads touch one element between two barriers.
unsafe impl<T: Send> Sync for Shared<'_, T> {}
// SAFETY: as a `&mut [T]`.
unsafe impl<T: Send> Send for Shared<'_, T> {}

impl<'a, T> Shared<'a, T> {
    pub(crate) fn new(slice: &'a mut [T]) -> Self {
        Self { pointer: slice.as_mut_ptr(), len: slice.len(), borrow: PhantomData }
    }

    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// # Safety
    /// No other worker touches element `i` until the next barrier, and the caller holds no other reference to it.
    #[inline(always)]
    #[allow(clippy::mut_from_ref, reason = "the colouring, not the borrow checker, keeps references apart")]
    pub(crate) unsafe fn at(&self, i: usize) -> &mut T {
        assert!(i < self.len, "element {i} of {}", self.len);
        // SAFETY: inside the slice; exclusive by the caller's promise.
        unsafe { &mut *self.pointer.add(i) }
    }

    /// # Safety
    /// No worker writes element `i` until the next barrier.
    #[inline(always)]
    pub(crate) unsafe fn read(&self, i: usize) -> &T {
        assert!(i < self.len, "element {i} of {}", self.len);
        // SAFETY: inside the slice; not written by the caller's promise.
        unsafe { &*self.pointer.add(i) }
    }

    /// # Safety
    /// As [`Self::at`], for every element of `range`.
    #[inline(always)]
    #[allow(clippy::mut_from_ref, reason = "the colouring, not the borrow checker, keeps references apart")]
    pub(crate) unsafe fn range(&self, range: Range<usize>) -> &mut [T] {
        assert!(range.start <= range.end && range.end <= self.len, "{range:?} of {}", self.len);
        // SAFETY: inside the slice; exclusive by the caller's promise.
        unsafe { std::slice::from_raw_parts_mut(self.pointer.add(range.start), range.end - range.start) }
    }
}
