//! Hands the link script to the linker.

fn main() {
    println!(
        "cargo:rustc-link-arg-bins=-T{}/sa1110.ld",
        env!("CARGO_MANIFEST_DIR")
    );
    println!("cargo:rerun-if-changed=sa1110.ld");
}
