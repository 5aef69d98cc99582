//! What surrounds the views: the header, the hint bar, and the windows that open over a view.

pub(super) mod header;
pub(super) mod hints;
pub(super) mod overlay;
