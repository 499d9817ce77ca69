//! The linker's side of the image. All its unsafe code.

use core::panic::PanicInfo;

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    // The panic gate proves that nobody comes here.
    loop {
        core::hint::spin_loop();
    }
}

// SAFETY: no other item of this image has this name.
#[unsafe(no_mangle)]
extern "C" fn show() {
    crate::show();
}
