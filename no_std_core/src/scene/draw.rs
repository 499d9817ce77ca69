//! One frame of a scene.

use super::{Instance, Lamp, MAX_LAMPS, Scene};
use crate::camera::Camera;
use crate::canvas::Canvas;
use crate::draw::Quality;
use crate::grid::{cast, traverse};
use crate::normal::CODES;
use crate::numbers::{Length, SplatPx, shift_round};
use crate::placement::{Inverse, NormalMap};
use crate::plan::Plan;
use crate::projection::{DepthToW, Projection, Sight};
use crate::resolve::{Shadowed, merge};
use crate::shade::Shader;
use crate::shadow::{CastForms, LightSpace, Map, Method, Receiver, Shadows, Sphere, bias, edge};
use crate::stats::Stats;
use crate::target::Layers;

/// Memory that a scene's frame needs beside its target.
pub struct Memory<'a> {
    /// [`crate::draw::shades_len`] words for the instance with the most
    /// materials. Where it is shorter, samples are shaded one by one.
    pub shades: &'a mut [u16],
    /// [`Shadows::map_len`] words for each lamp that casts. Lamps for which it
    /// is too short cast no shadows.
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
    let mut maps = Maps::cast(scene, memory.shadows, &mut stats);
    let sights = || {
        let placed = scene.instances.iter();
        placed.filter_map(|instance| Some((instance, instance.placement.sight(camera)?)))
    };
    let range = sights().fold([Length::MAX, Length::ONE], |[near, far], (_, sight)| {
        let [nearest, farthest] = sight.range();
        [near.min(nearest), far.max(farthest)]
    });
    target.clear();
    for (instance, sight) in sights() {
        let frame = InstanceFrame {
            instance,
            camera,
            quality,
            projection: Projection::of(camera, &sight, Some(range)),
            sight,
        };
        frame.draw(scene, memory.shades, &mut maps, target, &mut stats);
    }
    stats
}

/// One instance in one frame.
struct InstanceFrame<'f> {
    instance: &'f Instance<'f>,
    camera: &'f Camera,
    quality: &'f Quality,
    projection: Projection,
    sight: Sight,
}

impl InstanceFrame<'_> {
    fn draw(
        &self,
        scene: &Scene<'_>,
        shades: &mut [u16],
        maps: &mut Maps<'_>,
        target: &mut Layers<'_>,
        stats: &mut Stats,
    ) {
        let grid = self.instance.grid;
        let plan = Plan::with(grid, self.camera, self.quality, &self.projection);
        if plan.part.pixels() == 0 {
            return;
        }
        let Some(inverse) = Inverse::of(&self.instance.placement) else {
            return;
        };
        let normals = NormalMap::new(&self.instance.placement, inverse);
        let shades = if plan.tabulates { shades } else { &mut [] };
        let shader = Shader::placed(&scene.lighting, &normals, self.instance.colours(), shades);
        let cell = |space: &LightSpace| self.cell(space, &plan);
        let to_w = DepthToW::new(&self.projection);
        let receivers = maps.receivers((self, &to_w), &normals, &scene.shadows, cell);
        for strip in target.strips() {
            let part = strip.intersection(plan.part);
            if part.pixels() == 0 {
                continue;
            }
            let (canvas, picture) = target.parts();
            let mut canvas = Canvas::new(canvas, part);
            traverse(
                grid,
                self.sight.eye,
                &self.projection,
                &plan,
                &mut canvas,
                stats,
            );
            let shadowed = Shadowed {
                shader: &shader,
                receivers: &receivers,
            };
            merge(&canvas, plan.repair, &shadowed, picture);
        }
    }

    /// The edge of what the picture draws, texels of a map, Q16: a leaf, or as
    /// large as a splat in the middle of the grid.
    fn cell(&self, space: &LightSpace, plan: &Plan) -> u64 {
        let cells = plan.leaves_per_axis(self.instance.grid.rho());
        let leaf = edge(space, self.instance.placement.half_side()).checked_div(cells);
        let w = (self.sight.rows[2].0 >> 30).max(0);
        let splat = w * i128::from(self.quality.splat.max(SplatPx::ONE).to_bits()) / 2;
        let splat = (splat << 16).checked_div(i128::from(self.camera.focal_px.to_bits().max(1)));
        let splat = Length::from_bits(shift_round(splat.unwrap_or(0), 0).clamp(0, 1 << 40));
        leaf.unwrap_or(0).max(edge(space, splat))
    }
}

/// The maps of lamps that cast.
struct Maps<'m> {
    /// By lamp.
    maps: [Option<LampMap<'m>>; MAX_LAMPS],
}

struct LampMap<'m> {
    space: LightSpace,
    depths: &'m [u16],
    slopes: &'m mut [u16],
}

impl<'m> Maps<'m> {
    /// Draws the maps.
    fn cast(scene: &Scene<'_>, memory: &'m mut [u16], stats: &mut Stats) -> Self {
        let mut maps = [const { None }; MAX_LAMPS];
        if scene.shadows.method == Method::Off {
            return Self { maps };
        }
        let sphere = Sphere::around(scene.instances);
        let mut rest = memory;
        for (map, lamp) in maps.iter_mut().zip(scene.lighting.lamps) {
            if !lamp.casts {
                continue;
            }
            let Some((own, others)) = rest.split_at_mut_checked(scene.shadows.map_len()) else {
                break;
            };
            rest = others;
            *map = LampMap::cast(scene, lamp, sphere, own, stats);
        }
        Self { maps }
    }

    /// What pixels of an instance read in them.
    fn receivers<'r>(
        &'r mut self,
        (frame, to_w): (&InstanceFrame<'_>, &'r DepthToW),
        normals: &NormalMap,
        shadows: &Shadows,
        cell: impl Fn(&LightSpace) -> u64,
    ) -> [Option<Receiver<'r>>; MAX_LAMPS] {
        let view = (frame.camera, &frame.projection, to_w);
        self.maps.each_mut().map(|map| {
            let map = map.as_mut()?;
            let space = map.space;
            let instance = frame.instance;
            let cast = CastForms::new(&space, instance.grid, &instance.placement, shadows.splat);
            let bias = bias(&space, &cast, cell(&space), shadows.bias);
            let memory = (map.depths, &mut *map.slopes);
            Receiver::new(&space, memory, normals, view, bias)
        })
    }
}

impl<'m> LampMap<'m> {
    /// Draws a lamp's map.
    fn cast(
        scene: &Scene<'_>,
        lamp: &Lamp,
        sphere: Sphere,
        memory: &'m mut [u16],
        stats: &mut Stats,
    ) -> Option<Self> {
        let Shadows { size, splat, .. } = scene.shadows;
        let space = LightSpace::new(lamp.towards, sphere, size);
        let texels = usize::from(size) * usize::from(size);
        let (depths, slopes) = memory.split_at_mut_checked(texels)?;
        let mut map = Map::new(depths, size);
        for instance in scene.instances {
            let Some(inverse) = Inverse::of(&instance.placement) else {
                continue;
            };
            let away = NormalMap::new(&instance.placement, inverse).away(lamp.towards);
            let away = (!instance.grid.two_sided()).then_some(away);
            let forms = CastForms::new(&space, instance.grid, &instance.placement, splat);
            cast(instance.grid, &forms, away, &mut map, stats);
        }
        Some(Self {
            space,
            depths,
            slopes: slopes.get_mut(..CODES / 2)?,
        })
    }
}
