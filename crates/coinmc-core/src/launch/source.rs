//! The source of an engine's launches.

use super::{Launch, Launches, Starts};

/// Number of launches per call of an iterator behind a pointer.
const BLOCK: usize = 64;

/// The launches of many tosses, in order: drawn from a distribution, or from any iterator.
///
/// It is a single type, so that engines are compiled once for all sources; and launches are fetched
/// in blocks, so that none costs a call through a pointer.
///
/// # Example
/// ```
/// use coinmc_core::{Coin, Domain, LaunchSource, Lanes, Preset, Stream};
/// let coin = Coin::cylinder(1.5, 0.01)?;
/// let (robot, stream) = (Preset::Robot.distribution(), Stream::new(1, Domain::Launch, 0));
/// let drawn = LaunchSource::from(robot.launches(&coin, &stream, 0..100, Lanes::best()));
/// let mut own = (0..100).map(|toss| robot.launch(&coin, &mut stream.toss(toss)));
/// assert!(drawn.eq(LaunchSource::new(&mut own)));
/// # Ok::<(), coinmc_core::CoinError>(())
/// ```
pub struct LaunchSource<'a> {
    source: Source<'a>,
    /// Where each launch is noted.
    noted: Option<&'a Starts>,
}

// There is one per batch, so its size has no cost; a pointer to follow at every launch would.
#[allow(clippy::large_enum_variant)]
enum Source<'a> {
    Drawn(Launches),
    Own {
        launches: &'a mut dyn Blocks,
        block: Vec<Launch>,
        next: usize,
    },
}

/// An iterator over launches that is called once per block.
trait Blocks {
    fn next_block(&mut self, block: &mut Vec<Launch>);
}

impl<I: Iterator<Item = Launch>> Blocks for I {
    fn next_block(&mut self, block: &mut Vec<Launch>) {
        block.extend(self.take(BLOCK));
    }
}

impl<'a> LaunchSource<'a> {
    /// Uses these launches. More of them may be taken than are tossed.
    pub fn new(launches: &'a mut impl Iterator<Item = Launch>) -> Self {
        Self::of(Source::Own {
            launches,
            block: Vec::new(),
            next: 0,
        })
    }

    /// The same launches, noting which face is up at each, after those that were noted before.
    #[must_use]
    pub fn noting(self, starts: &'a Starts) -> Self {
        Self {
            noted: Some(starts),
            ..self
        }
    }

    fn of(source: Source<'a>) -> Self {
        Self {
            source,
            noted: None,
        }
    }
}

impl From<Launches> for LaunchSource<'_> {
    fn from(launches: Launches) -> Self {
        Self::of(Source::Drawn(launches))
    }
}

impl Iterator for LaunchSource<'_> {
    type Item = Launch;

    #[inline]
    fn next(&mut self) -> Option<Launch> {
        let launch = self.source.next();
        if let (Some(starts), Some(launch)) = (self.noted, &launch) {
            starts.note(launch);
        }
        launch
    }
}

impl Source<'_> {
    #[inline]
    fn next(&mut self) -> Option<Launch> {
        match self {
            Self::Drawn(launches) => launches.next(),
            Self::Own {
                launches,
                block,
                next,
            } => {
                if *next == block.len() {
                    block.clear();
                    launches.next_block(block);
                    *next = 0;
                }
                let launch = *block.get(*next)?;
                *next += 1;
                Some(launch)
            }
        }
    }
}
