//! `rhogrid compare`.

use serde_json::Value;

use super::{Folder, assert_keys, png};

fn folder() -> Folder {
    let folder = Folder::new();
    folder.done("render cube.obj -o a.png --level 2 --size 40x30");
    folder.done("render cube.obj -o b.png --level 2 --size 40x30 --yaw 20");
    folder
}

#[test]
fn identical_pictures_have_no_psnr() {
    let folder = folder();
    let measures = folder.json("compare a.png a.png");
    assert_keys(&measures, &["psnr", "ssim", "rmse", "max_error"]);
    assert_eq!(measures["psnr"], Value::Null);
    assert_eq!(measures["ssim"], 1.0);
    assert_eq!(measures["rmse"], 0.0);
    assert_eq!(measures["max_error"], 0);
    assert_eq!(folder.done("compare a.png a.png"), "identical\n");
}

#[test]
fn different_pictures_have_every_measure_either_way_round() {
    let folder = folder();
    let measures = folder.json("compare a.png b.png");
    assert_eq!(measures, folder.json("compare b.png a.png"));
    let psnr = measures["psnr"].as_f64().unwrap();
    let rmse = measures["rmse"].as_f64().unwrap();
    assert!(psnr > 3.0 && psnr < 50.0, "{measures}");
    assert!(
        (psnr - 20.0 * (255.0 / rmse).log10()).abs() < 1e-9,
        "{measures}"
    );
    assert!(measures["max_error"].as_u64().unwrap() > 0);
    assert!(measures["ssim"].as_f64().unwrap() < 1.0);
    assert!(folder.done("compare a.png b.png").contains("dB"));
}

#[test]
fn the_difference_is_a_picture_of_the_same_size() {
    let folder = folder();
    folder.done("compare a.png b.png --difference d.png");
    let picture = png(&folder.path("d.png"));
    assert_eq!((picture.width, picture.height), (40, 30));
    assert!(picture.rgb.iter().any(|&pixel| pixel != [0; 3]));
    folder.done("compare a.png a.png --difference d.png");
    assert!(
        png(&folder.path("d.png"))
            .rgb
            .iter()
            .all(|&pixel| pixel == [0; 3])
    );
}
