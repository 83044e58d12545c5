//! The full field against closed forms and independent tables.

mod bench;
mod hertz;
mod maugis_dugdale;
mod rough;
mod tables;
mod waves;
