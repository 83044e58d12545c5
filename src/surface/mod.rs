//! Heights: the sum of a scene's surface parts on its grid.
