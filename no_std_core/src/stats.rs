//! What a frame cost: counters that the draw loops keep.

/// Work done for one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Occupancy masks read.
    pub nodes_visited: u32,
    /// Nodes skipped with their subtrees because every surface in them faces
    /// away from the eye.
    pub nodes_back_facing: u32,
    /// Nodes skipped because they lie outside the picture or behind the eye.
    pub nodes_outside: u32,
    /// Nodes skipped with their subtrees because what is drawn hides them.
    pub nodes_hidden: u32,
    /// Cones tested for facing away.
    pub facing_tests: u32,
    /// Cells tested against the sides of a strip.
    pub side_tests: u32,
    /// Samples that reached the depth test.
    pub samples_drawn: u32,
    /// Those of them that were projected one by one and drawn as splats of
    /// their own size.
    pub splats_drawn: u32,
    /// Traversals for shadow maps alone: one for each map, none where they are
    /// drawn with the picture.
    pub shadow_passes: u32,
    /// Occupancy masks read for shadow maps.
    pub casters_visited: u32,
    /// Squares drawn into shadow maps.
    pub casters_drawn: u32,
}
