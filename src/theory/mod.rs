//! Closed forms and asperity models that the full field is judged by.
