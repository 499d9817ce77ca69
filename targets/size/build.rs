//! Makes the image's entry the only thing that the linker keeps.

fn main() {
    println!("cargo:rustc-link-arg-bins=--entry=show");
    println!("cargo:rerun-if-changed=build.rs");
}
