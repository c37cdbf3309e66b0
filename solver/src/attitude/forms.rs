//! The input forms of an attitude.
