//! What the engine makes of a toss that could be heard: when the coin strikes the surface, and how hard.

use coinmc::plan::Point;
use coinmc_core::{
    DynEngine, Engine, EngineError, Event, EventKind, Launch, Observer, Scene, State, SurfaceError,
};
use thiserror::Error;

/// Radius, m, of the table on which tosses are followed: no coin reaches its edge, and a toss on a table with
/// an edge goes on until the coin rests, long after its face is decided.
const WIDE_TABLE_M: f64 = 1e4;
/// Strikes of a toss that are kept. The last of a rattle are too close to be heard one by one.
const MOST: usize = 4096;

/// The coin strikes the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strike {
    /// Time since the launch, s.
    pub time_s: f64,
    /// Impulse along the normal over the coin's mass, m/s.
    pub speed_m_s: f64,
}

/// The strikes of a toss, in order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Struck {
    /// The strikes.
    pub strikes: Vec<Strike>,
    /// When the coin rested or the toss was given up, s since the launch.
    pub end_s: f64,
}

/// Why nothing can be heard of a scene's tosses.
#[derive(Debug, Error)]
pub enum StruckError {
    /// The surface cannot have a far edge.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The engine refuses the scene.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The engine makes no tosses.
    #[error("a closed form makes no sound: choose [engine.volumetric]")]
    Silent,
}

/// Tosses of one scene, followed until the coin rests.
#[derive(Debug, Clone)]
pub struct Tosser {
    engine: DynEngine,
}

impl Tosser {
    /// For the scene of a point, on a table so wide that its edge does not matter.
    ///
    /// # Errors
    /// [`StruckError`] if the scene makes no tosses.
    pub fn new(point: &Point) -> Result<Self, StruckError> {
        let mut wide = point.clone();
        wide.scene = on_wide_table(&point.scene)?;
        let engine = wide.build_engine()?.ok_or(StruckError::Silent)?;
        Ok(Self { engine })
    }

    /// The strikes of one toss.
    pub fn strikes(&self, launch: &Launch) -> Struck {
        let mut heard = Heard::default();
        self.engine.toss(&mut (), launch, &mut heard);
        Struck {
            strikes: heard.strikes,
            end_s: heard.end_s,
        }
    }

    /// One toss, shown to an observer.
    pub(crate) fn show(&self, launch: &Launch, observer: &mut impl Observer) {
        self.engine.toss(&mut (), launch, observer);
    }
}

/// The scene on a table whose edge is far; a table with an edge stays as it is.
fn on_wide_table(scene: &Scene) -> Result<Scene, SurfaceError> {
    let mut wide = *scene;
    if wide.surface.table_radius_m().is_none() {
        wide.surface = wide.surface.with_table_radius(WIDE_TABLE_M)?;
    }
    Ok(wide)
}

/// Collects strikes: the velocity of the centre just before and just after each impact.
#[derive(Debug, Default)]
struct Heard {
    strikes: Vec<Strike>,
    before: Option<State>,
    end_s: f64,
}

impl Observer for Heard {
    fn event(&mut self, event: &Event) {
        let state = event.state;
        self.end_s = state.time_s;
        match event.kind {
            EventKind::Touching => self.before = Some(state),
            EventKind::Impact => {
                if let Some(before) = self.before.take() {
                    self.strikes.push(Strike {
                        time_s: state.time_s,
                        speed_m_s: (state.velocity_m_s - before.velocity_m_s).z.abs(),
                    });
                }
            }
            _ => {}
        }
    }

    fn has_seen_enough(&self) -> bool {
        self.strikes.len() >= MOST
    }
}
