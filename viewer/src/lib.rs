//! Streams a run to rerun
