//! stub
/// A grid.
pub struct Grid<'a> { bytes: &'a [u8] }
/// Error.
#[derive(Debug)]
pub enum AssetError { /// x
 Truncated }
impl<'a> Grid<'a> {
    /// Opens, validates.
    pub fn open(bytes: &'a [u8]) -> Result<Self, AssetError> { if bytes.len() < 4 { Err(AssetError::Truncated) } else { Ok(Self { bytes }) } }
    /// Number of words of the full shade table.
    pub fn shades_len(&self) -> usize { 8192 * (self.bytes.len().min(1)) }
}
