//! Shared set-up of the tests: reference scenarios and builders.
