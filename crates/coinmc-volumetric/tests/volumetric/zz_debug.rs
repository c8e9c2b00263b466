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
#[test] fn dbg_und() {
  let scene = scene(0.85,0.0,0.3,0.01); let model=Model::new(&scene);
  let energy = Settings{decision:Decision::Energy,..Settings::default()};
  let (a,b)=(Tosser::new(&scene),Tosser::with(&scene,&energy)); let mut k=0;
  for toss in 0..2500 { let l=preset(Preset::Clean,&scene,250,toss); let oa=a.toss(&l); let (ob,ms)=b.record(&scene,&l); if oa.face().is_none()||ob.face().is_none() { println!("UND {toss} {oa:?} {ob:?} events {}",ms.len()); k+=1; if k<3 {dump(&model,&ms[ms.len().saturating_sub(6)..]);} } }
}
#[test] fn dbg_sheet() {
  let scene = scene(1e-4,0.0,0.3,0.01); let model=Model::new(&scene); let e=Tosser::new(&scene); let mut k=0;
  for toss in 0..500 { let l=Start::lively(&mut Dice::new(233,toss)).launch(&scene); let (o,ms)=e.record(&scene,&l); if o.face().is_none() { println!("SHEET {toss} {o:?} events {}",ms.len()); k+=1; if k<3 {dump(&model,&ms[..5.min(ms.len())]); println!(".."); dump(&model,&ms[ms.len().saturating_sub(5)..]);} if k>6 {break;} } }
}
#[test] fn dbg_rk() {
  // which component
  let mut worst: f64 = 0.0; let _ = &mut worst;
}
#[test] fn dbh_gain() {
  let trial=3252; let mut dice = Dice::new(212, trial);
  let coin = Coin::cylinder(dice.scale(1e-3, 1e3), 0.01).unwrap();
  let e = dice.pick(&[0.0, 0.3, 0.8, 1.0]); let mu = dice.pick(&[0.0, 0.1, 0.5, 2.0, 10.0]);
  let mut length = || dice.pick(&[0.0, 1e-6, 1e-4, 1e-3]); let (c,p)=(length(),length());
  let surface = Surface::new(e, mu).and_then(|s| s.with_friction_lengths(c,p)).unwrap();
  let scene = Scene::new(coin, surface, 9.81).unwrap(); let model=Model::new(&scene);
  let mut start = Start::lively(&mut dice); start.spin *= dice.pick(&[0.1, 1.0, 10.0]);
  let (o,ms)=Tosser::new(&scene).record(&scene,&start.launch(&scene)); println!("{o:?} {}", ms.len());
  let i = ms.windows(2).position(|p| p[0].kind==EventKind::Sliding && p[1].motion.energy(&model)>p[0].motion.energy(&model)*(1.0+1e-9)).unwrap_or(3);
  dump(&model,&ms[i.saturating_sub(8)..(i+3).min(ms.len())]);
  for m in &ms[i.saturating_sub(8)..(i+3).min(ms.len())] { println!("norm {} z {} R {}", m.motion.axis.norm(), m.motion.position.z, model.radius); }
}
#[test] fn dbh_level() {
  let scene = scene(0.5,0.0,0.3,0.01); let model=Model::new(&scene);
  let launch = Launch{height_m:1.0,velocity_m_s:nalgebra::Vector3::zeros(),axis:nalgebra::UnitVector3::new_unchecked(nalgebra::Vector3::z()),spin_rad_s:nalgebra::Vector3::zeros()};
  let (o,ms)=Tosser::new(&scene).record(&scene,&launch); println!("{o:?}"); dump(&model,&ms[..9.min(ms.len())]);
}
