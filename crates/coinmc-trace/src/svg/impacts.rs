//! Marks of impacts on the ground.

use super::canvas::{Anchor, Canvas, TEXT};
use super::view::Shot;

/// Sizes of the marks of the hardest and the softest impact, px.
const LARGEST: f64 = 11.0;
const SMALLEST: f64 = 4.0;
/// Successive impacts within this distance, px, share a mark.
const SHARED: f64 = 10.0;
/// Smallest distance between two numbers, px.
const LEGIBLE: f64 = 24.0;

/// Impacts that share a mark.
struct Group {
    x: f64,
    first: usize,
    last: usize,
    hardest: f64,
}

/// Draws the impacts among `shots` from index `first` on, numbered from the launch. `at` maps a
/// point on the ground to the picture.
pub(super) fn draw(
    canvas: &mut Canvas,
    shots: &[Shot],
    first: usize,
    at: impl Fn(f64) -> [f64; 2],
) {
    let groups = groups(shots, first, &at);
    let hardest = groups.iter().map(|group| group.hardest).fold(0.0, f64::max);
    let [_, ground] = at(0.0);
    let mut named: Vec<f64> = Vec::new();
    for group in &groups {
        let share = if hardest > 0.0 {
            (group.hardest / hardest).max(0.0).sqrt()
        } else {
            1.0
        };
        let size = SMALLEST + (LARGEST - SMALLEST) * share;
        let style = format!("fill=\"{TEXT}\" stroke=\"#ffffff\" stroke-width=\"0.5\"");
        canvas.triangle([group.x, ground + 1.0], size, &style);
        if named.iter().any(|x| (x - group.x).abs() < LEGIBLE) {
            continue;
        }
        named.push(group.x);
        let name = if group.last > group.first {
            format!("{}–{}", group.first, group.last)
        } else {
            group.first.to_string()
        };
        let below = [group.x, ground + LARGEST + 13.0];
        canvas.label(below, 11.0, Anchor::Middle, TEXT, &name);
    }
}

fn groups(shots: &[Shot], first: usize, at: impl Fn(f64) -> [f64; 2]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let impacts = shots
        .iter()
        .enumerate()
        .filter(|(_, shot)| shot.is_impact());
    for (number, (index, shot)) in impacts.enumerate() {
        if index < first {
            continue;
        }
        let [x, _] = at(shot.foot);
        let number = number + 1;
        match groups.last_mut() {
            Some(group) if (group.x - x).abs() < SHARED => {
                group.last = number;
                group.hardest = group.hardest.max(shot.approach_m_s);
            }
            _ => groups.push(Group {
                x,
                first: number,
                last: number,
                hardest: shot.approach_m_s,
            }),
        }
    }
    groups
}
