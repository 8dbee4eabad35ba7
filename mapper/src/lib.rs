//! Says what a model is and which physics it has, with the reason for every value
