//! One frame of a scene.

use super::{Instance, MAX_LAMPS, Scene, order};
use crate::camera::Camera;
use crate::canvas::{Canvas, Pixel};
use crate::divisor::Divisor;
use crate::draw::Quality;
use crate::grid::{cast, traverse, traverse_and_cast};
use crate::numbers::{Length, SplatPx, Unit};
use crate::placement::{Inverse, NormalMap};
use crate::plan::Plan;
use crate::projection::{DepthToW, Projection, Sight};
use crate::resolve::{Shadowed, merge};
use crate::shade::{Paint, Shader};
use crate::shadow::{
    CastForms, LightSpace, Map, Method, PictureForms, Receiver, Sphere, bias, edge,
};
use crate::stats::Stats;
use crate::target::{Layers, blank};

/// Memory that a scene's frame needs beside its target.
pub struct Memory<'a> {
    /// [`crate::draw::shades_len`] words for the instance with the most
    /// materials. Where it is shorter, samples are shaded one by one.
    pub shades: &'a mut [u16],
    /// [`crate::shadow::Shadows::map_len`] words for each lamp that casts. Lamps
    /// for which it is too short cast no shadows.
    pub shadows: &'a mut [u16],
}

/// Clears the target and draws a scene into it. Cannot fail.
#[inline(never)]
pub fn draw_scene(
    scene: &Scene<'_>,
    camera: &Camera,
    quality: &Quality,
    memory: Memory<'_>,
    target: &mut Layers<'_>,
) -> Stats {
    let mut stats = Stats::default();
    let mut maps = Maps::new(scene, camera, memory.shadows);
    let order = one_pass_order(scene, &maps, target);
    if order.is_none() {
        maps.cast(scene, &mut stats);
    }
    let seen = |instance: &Instance<'_>| {
        let inverse = Inverse::of(&instance.placement)?;
        Some((instance.placement.sight(camera, &inverse), inverse))
    };
    let range = match scene.instances {
        [_] => None,
        _ => Some(range(
            scene
                .instances
                .iter()
                .filter_map(seen)
                .map(|(sight, _)| sight),
        )),
    };
    target.clear();
    for place in 0..scene.instances.len() {
        let index = order.as_ref().and_then(|order| order.get(place));
        let instance = scene.instances.get(*index.unwrap_or(&place));
        if let Some(instance) = instance
            && let Some((sight, inverse)) = seen(instance)
        {
            let frame = InstanceFrame {
                scene,
                instance,
                camera,
                quality,
                projection: Projection::of(camera, &sight, range),
                normals: NormalMap::new(&instance.placement, inverse),
                sight,
                casts: order.is_some(),
            };
            frame.draw(memory.shades, &mut maps, target, &mut stats);
        }
    }
    stats
}

/// The w between which depths resolve, so that those of all instances compare.
fn range(sights: impl Iterator<Item = Sight>) -> [Length; 2] {
    sights.fold([Length::MAX, Length::DELTA], |[near, far], sight| {
        let [nearest, farthest] = sight.range();
        [near.min(nearest), far.max(farthest)]
    })
}

/// The order of instances in which one pass serves: where one lamp casts, and
/// the picture is one strip. `None` where maps are to be drawn before.
fn one_pass_order(
    scene: &Scene<'_>,
    maps: &Maps<'_>,
    target: &Layers<'_>,
) -> Option<[usize; order::MOST]> {
    let is_asked_for = scene.shadows.method == Method::OnePass;
    let mut spaces = maps.maps.iter().flatten().map(|map| map.space);
    match (spaces.next(), spaces.next()) {
        (Some(space), None) if is_asked_for && is_one_strip(scene, target) => {
            order::along(&space, scene.instances)
        }
        _ => None,
    }
}

/// Whether every instance is drawn in one strip.
fn is_one_strip(scene: &Scene<'_>, target: &Layers<'_>) -> bool {
    let words = target.canvas_len();
    let mut paints = scene.instances.iter().map(|instance| instance.paint(words));
    match paints.any(|paint| matches!(paint, Paint::Samples(_))) {
        true => target.strips::<[u32; 2]>().nth(1).is_none(),
        false => target.strips::<u32>().nth(1).is_none(),
    }
}

/// One instance in one frame.
struct InstanceFrame<'f> {
    scene: &'f Scene<'f>,
    instance: &'f Instance<'f>,
    camera: &'f Camera,
    quality: &'f Quality,
    projection: Projection,
    normals: NormalMap,
    sight: Sight,
    /// Whether it is cast while it is drawn.
    casts: bool,
}

impl InstanceFrame<'_> {
    fn draw(
        &self,
        shades: &mut [u16],
        maps: &mut Maps<'_>,
        target: &mut Layers<'_>,
        stats: &mut Stats,
    ) {
        match self.instance.paint(target.canvas_len()) {
            paint @ Paint::Samples(_) => {
                self.draw_on::<[u32; 2]>((paint, shades), maps, target, stats);
            }
            paint => self.draw_on::<u32>((paint, shades), maps, target, stats),
        }
    }

    /// The same with pixels of one kind.
    #[inline(always)]
    fn draw_on<P: Pixel>(
        &self,
        (paint, shades): (Paint<'_>, &mut [u16]),
        maps: &mut Maps<'_>,
        target: &mut Layers<'_>,
        stats: &mut Stats,
    ) {
        let grid = self.instance.grid;
        let plan = Plan::with(grid, self.camera, self.quality, &self.projection);
        let shades = if plan.tabulates { shades } else { &mut [] };
        let shader = Shader::placed(
            &self.scene.lighting,
            self.camera,
            &self.normals,
            paint,
            shades,
        );
        let to_w = DepthToW::new(&self.projection);
        for strip in target.strips::<P>() {
            let (canvas, picture) = target.parts();
            let mut canvas = Canvas::<P>::new(canvas, strip.intersection(plan.part));
            self.traverse(&plan, maps, &mut canvas, stats);
            let shadowed = Shadowed {
                shader: &shader,
                receivers: &maps.receivers(self, &to_w, |space| self.cell(space, &plan)),
            };
            merge(&canvas, plan.repair, &shadowed, picture);
        }
    }

    fn traverse<P: Pixel>(
        &self,
        plan: &Plan,
        maps: &mut Maps<'_>,
        canvas: &mut Canvas<'_, P>,
        stats: &mut Stats,
    ) {
        let grid = self.instance.grid;
        let is_seen = canvas.strip.pixels() > 0;
        if self.casts {
            for map in maps.maps.iter_mut().flatten() {
                let (forms, away) = map.forms(self.scene, self.instance, &self.normals);
                let mut texels = map.texels();
                if is_seen {
                    let view = (self.sight.eye, &self.projection, plan);
                    let light = (&forms, away, &mut texels);
                    traverse_and_cast(grid, view, light, canvas, stats);
                } else {
                    cast(grid, &forms, away, &mut texels, stats);
                }
            }
        } else if is_seen {
            let eye = self.sight.eye;
            traverse(grid, eye, &self.projection, plan, canvas, stats);
        }
    }

    /// The edge of what the picture draws, texels of a map, Q16: a leaf, or as
    /// large as a splat in the middle of the grid.
    fn cell(&self, space: &LightSpace, plan: &Plan) -> u64 {
        let cells = plan.leaves_per_axis(self.instance.grid.rho());
        let leaf = edge(space, self.instance.placement.half_side()).checked_div(cells);
        let w = (self.sight.rows[2].0 >> 30).max(0);
        let splat = w * i128::from(self.quality.splat.max(SplatPx::ONE).to_bits()) / 2;
        let focal = Divisor::new(i128::from(self.camera.focal_px.to_bits()));
        let splat = Length::from_bits(focal.quotient(splat, 16).clamp(0, 1 << 40));
        leaf.unwrap_or(0).max(edge(space, splat))
    }
}

/// The maps of lamps that cast.
struct Maps<'m> {
    /// By lamp.
    maps: [Option<LampMap<'m>>; MAX_LAMPS],
}

struct LampMap<'m> {
    towards: [Unit; 3],
    space: LightSpace,
    picture: PictureForms,
    depths: &'m mut [u16],
    slopes: &'m mut [u16],
}

impl<'m> Maps<'m> {
    /// Clear maps.
    fn new(scene: &Scene<'_>, camera: &Camera, memory: &'m mut [u16]) -> Self {
        let mut maps = [const { None }; MAX_LAMPS];
        if scene.shadows.method == Method::Off {
            return Self { maps };
        }
        let sphere = Sphere::around(scene.instances);
        let size = scene.shadows.size;
        let texels = usize::from(size) * usize::from(size);
        let mut rest = memory;
        for (map, lamp) in maps.iter_mut().zip(scene.lighting.lamps) {
            if !lamp.casts {
                continue;
            }
            let Some((own, others)) = rest.split_at_mut_checked(scene.shadows.map_len()) else {
                break;
            };
            rest = others;
            let Some((depths, slopes)) = own.split_at_mut_checked(texels) else {
                break;
            };
            blank(depths);
            let space = LightSpace::new(lamp.towards, sphere, size);
            *map = Some(LampMap {
                towards: lamp.towards,
                picture: PictureForms::new(&space, camera),
                space,
                depths,
                slopes,
            });
        }
        Self { maps }
    }

    /// Draws all of them.
    fn cast(&mut self, scene: &Scene<'_>, stats: &mut Stats) {
        for map in self.maps.iter_mut().flatten() {
            stats.shadow_passes += 1;
            for instance in scene.instances {
                if let Some(inverse) = Inverse::of(&instance.placement) {
                    let normals = NormalMap::new(&instance.placement, inverse);
                    let (forms, away) = map.forms(scene, instance, &normals);
                    cast(instance.grid, &forms, away, &mut map.texels(), stats);
                }
            }
        }
    }

    /// What pixels of an instance read in them, `cell` being the edge of what is
    /// drawn of it.
    fn receivers<'r>(
        &'r mut self,
        frame: &InstanceFrame<'_>,
        to_w: &'r DepthToW,
        cell: impl Fn(&LightSpace) -> u64,
    ) -> [Option<Receiver<'r>>; MAX_LAMPS] {
        let shadows = &frame.scene.shadows;
        self.maps.each_mut().map(|map| {
            let map = map.as_mut()?;
            let (forms, _) = map.forms(frame.scene, frame.instance, &frame.normals);
            let bias = bias(&map.space, &forms, cell(&map.space), shadows.bias);
            let view = (&map.picture, &frame.projection, to_w);
            let memory = (&*map.depths, &mut *map.slopes);
            Receiver::new(&map.space, memory, &frame.normals, view, bias)
        })
    }
}

impl LampMap<'_> {
    fn texels(&mut self) -> Map<'_> {
        Map::new(self.depths, self.space.size)
    }

    /// How an instance reaches the map, and what leads away from the light, if
    /// that counts.
    fn forms(
        &self,
        scene: &Scene<'_>,
        instance: &Instance<'_>,
        normals: &NormalMap,
    ) -> (CastForms, Option<[i32; 3]>) {
        let Instance {
            grid, placement, ..
        } = instance;
        let forms = CastForms::new(&self.space, grid, placement, scene.shadows.splat);
        let away = (!grid.two_sided()).then(|| normals.away(self.towards));
        (forms, away)
    }
}
