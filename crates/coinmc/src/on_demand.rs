//! Long lists whose items are made when they are asked for.

use std::borrow::Cow;
use std::fmt;
use std::ops::{Index, IndexMut};
use std::sync::{Arc, OnceLock};

/// Longest list that is held whole.
pub(crate) const WHOLE: usize = 4096;
/// Items that are made, and kept, together.
const BLOCK: usize = 64;

/// A list, held whole if it is short. The items of a long list are made when they are asked for: a plan of
/// a million points would fill gigabytes.
///
/// [`at`](Self::at) and [`each`](Self::each) keep nothing. References, from `list[i]` or
/// [`iter`](Self::iter), live as long as the list, which then keeps what they refer to.
///
/// # Example
/// ```
/// use coinmc::OnDemand;
/// let squares = OnDemand::made(1_000_000, |i| i * i);
/// assert_eq!((squares.len(), *squares.at(1000), squares[3]), (1_000_000, 1_000_000, 9));
/// assert_eq!(squares.each().skip(10).map(|square| *square).next(), Some(100));
/// assert_eq!(OnDemand::from(vec![4, 5]).get(2), None);
/// ```
pub struct OnDemand<T>(List<T>);

type Make<T> = Arc<dyn Fn(usize) -> T + Send + Sync>;

enum List<T> {
    Whole(Vec<T>),
    Made {
        len: usize,
        make: Make<T>,
        kept: Box<[OnceLock<Box<[T]>>]>,
    },
}

impl<T> OnDemand<T> {
    /// A list of `len` items, of which `make` makes each, always the same.
    pub fn made(len: usize, make: impl Fn(usize) -> T + Send + Sync + 'static) -> Self {
        if len <= WHOLE {
            return Self(List::Whole((0..len).map(make).collect()));
        }
        Self::lazily(len, Arc::new(make))
    }

    fn lazily(len: usize, make: Make<T>) -> Self {
        let blocks = (0..len.div_ceil(BLOCK)).map(|_| OnceLock::new());
        let kept = blocks.collect();
        Self(List::Made { len, make, kept })
    }

    /// Number of items.
    pub fn len(&self) -> usize {
        match &self.0 {
            List::Whole(items) => items.len(),
            List::Made { len, .. } => *len,
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The item at this place, which is kept; `None` beyond the end.
    pub fn get(&self, index: usize) -> Option<&T> {
        match &self.0 {
            List::Whole(items) => items.get(index),
            List::Made { len, make, kept } => (index < *len).then(|| {
                let first = index - index % BLOCK;
                let block = || {
                    (first..*len.min(&(first + BLOCK)))
                        .map(|i| make(i))
                        .collect()
                };
                &kept[index / BLOCK].get_or_init(block)[index % BLOCK]
            }),
        }
    }

    /// The first item, which is kept.
    pub fn first(&self) -> Option<&T> {
        self.get(0)
    }

    /// The items, which are kept.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &T> + DoubleEndedIterator + Clone {
        (0..self.len()).map(|index| &self[index])
    }
}

impl<T: Clone> OnDemand<T> {
    /// The item at this place. It is not kept because of this; if it is kept already, it is that one, which may have
    /// been changed.
    ///
    /// # Panics
    /// Beyond the end.
    pub fn at(&self, index: usize) -> Cow<'_, T> {
        match &self.0 {
            List::Whole(items) => Cow::Borrowed(&items[index]),
            List::Made { len, make, kept } => {
                assert!(index < *len, "item {index} of {len}");
                let kept = kept[index / BLOCK].get();
                kept.map_or_else(
                    || Cow::Owned(make(index)),
                    |block| Cow::Borrowed(&block[index % BLOCK]),
                )
            }
        }
    }

    /// The items, one after the other; none is kept.
    pub fn each(&self) -> impl ExactSizeIterator<Item = Cow<'_, T>> + DoubleEndedIterator {
        (0..self.len()).map(|index| self.at(index))
    }
}

impl<T> From<Vec<T>> for OnDemand<T> {
    fn from(items: Vec<T>) -> Self {
        Self(List::Whole(items))
    }
}

impl<T> FromIterator<T> for OnDemand<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        Self(List::Whole(items.into_iter().collect()))
    }
}

impl<T> Index<usize> for OnDemand<T> {
    type Output = T;

    fn index(&self, index: usize) -> &T {
        let len = self.len();
        self.get(index)
            .unwrap_or_else(|| panic!("item {index} of {len}"))
    }
}

impl<T> IndexMut<usize> for OnDemand<T> {
    fn index_mut(&mut self, index: usize) -> &mut T {
        // so that there is something to change
        let _ = &self[index];
        match &mut self.0 {
            List::Whole(items) => &mut items[index],
            List::Made { kept, .. } => {
                let block = kept[index / BLOCK].get_mut().expect("just made");
                &mut block[index % BLOCK]
            }
        }
    }
}

impl<'a, T> IntoIterator for &'a OnDemand<T> {
    type Item = &'a T;
    type IntoIter = Box<dyn Iterator<Item = &'a T> + 'a>;

    fn into_iter(self) -> Self::IntoIter {
        Box::new(self.iter())
    }
}

impl<T: Clone> IntoIterator for OnDemand<T> {
    type Item = T;
    type IntoIter = std::vec::IntoIter<T>;

    /// The items; all of them are held at once.
    fn into_iter(self) -> Self::IntoIter {
        let items: Vec<T> = match self.0 {
            List::Whole(items) => items,
            List::Made { .. } => self.each().map(Cow::into_owned).collect(),
        };
        items.into_iter()
    }
}

impl<T: Clone> Clone for OnDemand<T> {
    fn clone(&self) -> Self {
        match &self.0 {
            List::Whole(items) => Self(List::Whole(items.clone())),
            List::Made { len, make, kept } => {
                let Self(List::Made { kept: copy, .. }) = Self::lazily(*len, Arc::clone(make))
                else {
                    unreachable!("it is long")
                };
                // what was kept may have been changed
                for (copy, kept) in copy.iter().zip(kept) {
                    if let Some(block) = kept.get() {
                        let _ = copy.set(block.clone());
                    }
                }
                Self(List::Made {
                    len: *len,
                    make: Arc::clone(make),
                    kept: copy,
                })
            }
        }
    }
}

impl<T: Clone + PartialEq> PartialEq for OnDemand<T> {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && self.each().zip(other.each()).all(|(a, b)| a == b)
    }
}

impl<T: fmt::Debug> fmt::Debug for OnDemand<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            List::Whole(items) => items.fmt(f),
            List::Made { len, .. } => write!(f, "[{len} items, made on demand]"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_keep_only_what_is_referred_to() {
        let made = Arc::new(std::sync::atomic::AtomicUsize::new(0));
        let counted = Arc::clone(&made);
        let list = OnDemand::made(WHOLE + 1, move |i| {
            counted.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            i
        });
        let so_far = || made.load(std::sync::atomic::Ordering::Relaxed);
        assert_eq!((*list.at(7), so_far()), (7, 1));
        assert_eq!((list[7], so_far()), (7, 1 + BLOCK));
        assert_eq!((list[8], so_far()), (8, 1 + BLOCK));
        assert_eq!((list[WHOLE], so_far()), (WHOLE, 2 + BLOCK));
        assert_eq!(list.get(WHOLE + 1), None);
        assert_eq!(list.iter().sum::<usize>(), (WHOLE + 1) * WHOLE / 2);
    }

    #[test]
    fn a_changed_item_stays_changed_in_copies() {
        for len in [3, WHOLE + 3] {
            let mut list = OnDemand::made(len, |i| i);
            list[2] = 77;
            let copy = list.clone();
            assert_eq!((copy[2], copy[1], copy.len()), (77, 1, len));
            assert_eq!((*copy.at(2), *copy.at(1)), (77, 1));
            assert!(copy == list && list != OnDemand::made(len, |i| i));
            assert_eq!(list.into_iter().nth(2), Some(77));
        }
    }
}
