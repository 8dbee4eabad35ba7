//! What do the names of a model say? Words, phrases of the catalogue found in them, and how much each counts.

pub(crate) mod evidence;
pub(crate) mod head;
pub(crate) mod lexicon;

pub(crate) mod plural;
pub(crate) mod reading;
pub(crate) mod signal;
pub(crate) mod spelling;
pub(crate) mod tokens;
