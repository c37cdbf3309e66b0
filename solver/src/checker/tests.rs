//! Tests of the verification: the motion against closed forms, then whole flights.

mod motion;
