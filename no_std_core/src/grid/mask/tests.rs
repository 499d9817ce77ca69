use std::vec::Vec;

use super::*;
use crate::asset::node::halves;
use crate::testing::Rng;

#[test]
fn slots_and_bits_name_each_other() {
    let mut seen = [false; SLOTS];
    for bit in 0..SLOTS {
        assert!(!core::mem::replace(&mut seen[slot(bit)], true), "bit {bit}");
        assert_eq!(usize::from(BITS[slot(bit)]), bit);
    }
}

/// The cells of random records against a walk over every bit.
fn cells_are_the_set_bits<const RHO: u8>(seed: u64) {
    let mut rng = Rng::with_seed(seed);
    let cubed = usize::from(RHO).pow(3);
    for _ in 0..1000 {
        let shape = rng.u16(..) & rng.u16(..);
        let record: Vec<u16> = (0..halves(RHO)).map(|_| rng.u16(..) & shape).collect();
        let wanted: Vec<usize> = (0..cubed)
            .filter(|bit| record[bit / 16] >> (bit % 16) & 1 != 0)
            .collect();
        let mask = Mask::<RHO>::of(&record);
        let words = mask.words().enumerate();
        let found: Vec<usize> = words
            .flat_map(|(index, word)| bits(word).map(move |bit| index * cells(RHO) + bit))
            .collect();
        assert_eq!(found, wanted, "rho {RHO}: {record:04x?}");
        assert_eq!(mask.count(), wanted.len(), "rho {RHO}: {record:04x?}");
        let others = mask.without(Mask::of(
            &record.iter().map(|half| half & 0x5555).collect::<Vec<_>>(),
        ));
        let odd = wanted.iter().filter(|&bit| bit % 2 == 1).count();
        assert_eq!(others.count(), odd, "rho {RHO}: {record:04x?}");
    }
}

#[test]
fn masks_hold_the_cells_of_their_records() {
    cells_are_the_set_bits::<2>(21);
    cells_are_the_set_bits::<3>(22);
    cells_are_the_set_bits::<4>(23);
    cells_are_the_set_bits::<5>(24);
}
