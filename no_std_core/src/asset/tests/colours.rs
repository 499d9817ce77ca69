//! Colours of samples.

use super::*;
use crate::asset::Colours;

fn painted(bits: u8) -> Model {
    let mut rng = Rng::with_seed(55);
    let mut model = Model::random(&mut rng, 3, 3, 60.0);
    model.paint(&mut rng);
    model.attribute_bits = bits;
    model
}

#[test]
fn colours_are_those_of_the_model() {
    for (bits, lost) in [(32u8, [7u8, 3, 7]), (48, [0; 3])] {
        let model = painted(bits);
        let bytes = aligned(&model.file().bytes());
        let grid = Grid::open(&bytes).expect("valid");
        assert_eq!(grid.attribute_bits(), bits);
        for (level, cells) in grid.levels().iter().zip(&model.levels) {
            for (index, cell) in cells.iter().enumerate() {
                let got = level.colours.get(index).expect("a colour");
                let want = model.materials[usize::from(cell.attribute >> 13)];
                for channel in 0..3 {
                    assert!(got[channel].abs_diff(want[channel]) <= lost[channel]);
                }
            }
            assert_eq!(level.colours.get(cells.len()), None);
        }
    }
    let plain = aligned(&painted(16).file().bytes());
    let grid = Grid::open(&plain).expect("valid");
    assert!(matches!(grid.levels()[0].colours, Colours::None));
    assert_eq!(grid.levels()[0].colours.get(0), None);
}

#[test]
fn full_and_empty_bits_are_full_and_empty_channels() {
    let colours = Colours::Rgb565(&[0, 0xffff, 0x8410]);
    assert_eq!(colours.get(0), Some([0; 3]));
    assert_eq!(colours.get(1), Some([255; 3]));
    assert_eq!(colours.get(2), Some([132, 130, 132]));
}

#[test]
fn colours_that_are_none_are_named() {
    let mut file = painted(48).file();
    let (_, last) = file.sections.last_mut().expect("levels");
    let cells = u32::from_le_bytes(last[..4].try_into().expect("four bytes"));
    *last.last_mut().expect("colours") = 1;
    let (depth, index) = (3, cells - 1);
    refused(&file.bytes(), AssetError::Colour { depth, index });
    // Of another length than the header says.
    for (own, said) in [(48, 32), (48, 16), (32, 48), (16, 32)] {
        let mut file = painted(own).file();
        file.header[11] = said;
        let opened = open(&file.bytes());
        assert!(matches!(opened, Err(AssetError::LevelSize { .. })));
    }
}
