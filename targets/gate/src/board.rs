//! The linker's side of the gate. All unsafe code of this image.

use core::panic::PanicInfo;

// SAFETY: declared only; an image that refers to it does not link.
unsafe extern "C" {
    safe fn a_panic_path_survives() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    a_panic_path_survives()
}

// SAFETY: no other item of this image has this name.
#[unsafe(no_mangle)]
extern "C" fn gate() {
    crate::every_entry();
}
