use crate::common::*;
use coinmc_core::*;
use coinmc_oracle::Model;
use coinmc_volumetric::*;
fn dump(m: &Model, ms: &[Moment]) {
    for x in ms {
        println!(
            "{:?} t={:.9} gap={:.2e} E={:.9} c={:.3e} v={:?} w={:?}",
            x.kind,
            x.time,
            x.motion.gap(m),
            x.motion.energy(m),
            x.motion.axis.z,
            x.motion.velocity.as_slice(),
            x.motion.spin.as_slice()
        );
    }
}
#[test]
fn dbg_approach() {
    let scene = scene(0.5, 0.0, 0.3, 0.01);
    let model = Model::new(&scene);
    let e = Tosser::new(&scene);
    let mut shown = 0;
    for trial in 0..400 {
        let start = Start::lively(&mut Dice::new(210, trial));
        let (o, ms) = e.record(&scene, &start.launch(&scene));
        for i in 1..ms.len() {
            if ms[i].kind == EventKind::Touching {
                let u = ms[i].motion.axis;
                let across = (u * u.z - nalgebra::Vector3::z()) / ms[i].motion.sine();
                let arm = across * model.radius - u * model.half.copysign(u.z);
                let v = ms[i].motion.velocity + ms[i].motion.spin.cross(&arm);
                if v.z > 1e-9 {
                    println!("trial {trial} {o:?} approach {}", v.z);
                    dump(&model, &ms[i.saturating_sub(6)..(i + 4).min(ms.len())]);
                    shown += 1;
                    break;
                }
            }
        }
        if shown > 2 {
            break;
        }
    }
}
#[test]
fn dbg_none() {
    let scene = scene(0.05, 0.8, 2.0, 0.01);
    let model = Model::new(&scene);
    let e = Tosser::new(&scene);
    let mut launch = preset(Preset::Clean, &scene, 222, 670);
    launch.velocity_m_s = Dice::new(1222, 670).vector(0.3);
    let (o, ms) = e.record(&scene, &launch);
    println!("{o:?}");
    dump(&model, &ms);
}
