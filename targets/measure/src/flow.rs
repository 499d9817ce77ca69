//! The flow itself.

use core::fmt;
use core::hint::black_box;

use rhogrid_core::asset::{AssetError, Grid};
use rhogrid_core::draw::shades_len;
use rhogrid_core::target::{TargetError, frame_hash};
use rhogrid_frame::{Frame, FrameError};

use crate::PROTOCOL;
use crate::board::{Board, Buffers};
use crate::content::{Content, Memories};

/// Loop counts whose cost must come out exactly: the timer's ticks fall on
/// instructions in a pattern, and these meet every phase of it.
const SPINS: [u32; 12] = [1, 2, 3, 5, 8, 13, 64, 127, 1000, 12_345, 99_999, 1_000_000];

/// Why the flow stopped.
#[derive(Debug)]
pub enum Failure {
    /// The memory for it holds no frame file.
    Frame(FrameError),
    /// The core refuses the asset.
    Asset(AssetError),
    /// The picture does not fit the buffers.
    Target(TargetError),
    /// An asset wants a longer shade table than this.
    Shades(usize),
    /// The lamps want more memory for shadow maps than this.
    Shadows(usize),
    /// An instance of no asset, or no instance.
    Instance,
    /// Drawing used all of the stack.
    Stack,
    /// Nobody listens.
    Print,
}

impl From<FrameError> for Failure {
    fn from(error: FrameError) -> Self {
        Self::Frame(error)
    }
}

impl From<AssetError> for Failure {
    fn from(error: AssetError) -> Self {
        Self::Asset(error)
    }
}

impl From<TargetError> for Failure {
    fn from(error: TargetError) -> Self {
        Self::Target(error)
    }
}

impl From<fmt::Error> for Failure {
    fn from(_: fmt::Error) -> Self {
        Self::Print
    }
}

/// Draws and measures what the frame file asks for. Returns when the last
/// line is printed; the last line of a failure is printed, too.
///
/// # Errors
/// When something keeps the views from being drawn.
pub fn run<B: Board>(board: &mut B, buffers: &'static mut Buffers) -> Result<(), Failure> {
    let result = measure_all(board, buffers);
    if let Err(failure) = &result {
        writeln!(board, "ERROR {failure:?}")?;
    }
    result
}

fn measure_all<B: Board>(board: &mut B, buffers: &'static mut Buffers) -> Result<(), Failure> {
    let frame = Frame::open(board.frame_file())?;
    let settings = frame.settings();
    let Buffers {
        colour,
        canvas,
        shades,
        depth,
        shadows,
        grids,
    } = buffers;
    for (grid, asset) in grids.iter_mut().zip(frame.assets()) {
        *grid = Some(Grid::open(asset)?);
    }
    let pixels = usize::from(settings.width) * usize::from(settings.height);
    let colour = colour.get_mut(..pixels).ok_or(TargetError::ColourLength)?;
    let depth = depth.get_mut(..pixels).ok_or(TargetError::DepthLength)?;
    let content = Content::new(&frame, grids)?;
    let (instances, count) = content.instances()?;
    let instances = instances.get(..count).unwrap_or(&instances);
    let shades_len = shades_len(content.materials());
    let mut memory = Memories {
        shades: shades
            .get_mut(..shades_len)
            .ok_or(Failure::Shades(shades_len))?,
        shadows: content.shadows(shadows)?,
        canvas,
    };

    writeln!(board, "RHOGRID {PROTOCOL} {}", frame.views().count())?;
    check_timer(board)?;
    for (index, view) in frame.views().enumerate() {
        content.draw(instances, &view.warm_up, colour, depth, &mut memory)?;

        board.paint_stack();
        board.restart_timer();
        let start = board.ticks();
        let stats = content.draw(instances, &view.measured, colour, depth, &mut memory)?;
        let end = board.ticks();
        let stack = board.painted_over().ok_or(Failure::Stack)?;
        black_box(stats);

        let hash = frame_hash(colour);
        writeln!(board, "VIEW {index} {start} {end} {hash:08x} {stack}")?;
    }
    if board.show(colour, settings.width, settings.height) {
        writeln!(board, "SHOWN {} {}", settings.width, settings.height)?;
    } else {
        writeln!(board, "DONE")?;
    }
    Ok(())
}

/// Prints what the host needs to know the cost of reading the timer, and to
/// see that the timer counts instructions.
fn check_timer<B: Board>(board: &mut B) -> fmt::Result {
    board.restart_timer();
    let start = board.ticks();
    let end = board.ticks();
    writeln!(board, "READ {start} {end}")?;
    for loops in SPINS {
        board.restart_timer();
        let start = board.ticks();
        board.spin(loops);
        let end = board.ticks();
        writeln!(board, "SPIN {loops} {start} {end}")?;
    }
    Ok(())
}
