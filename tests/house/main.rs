//! The house itself: modules look one way, pages follow the source, and effects that a scene does not
//! name cost nothing.

mod cost;
mod guide;
mod layers;
mod tests;
