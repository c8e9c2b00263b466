//! The checked description of a coin.

use crate::error::ShapeError;
use crate::marks::Marks;

/// The smallest diameter and thickness, m.
pub const MIN_SIZE_M: f64 = 1e-4;
/// The greatest diameter and thickness, m.
pub const MAX_SIZE_M: f64 = 1.0;
/// The smallest part of a shape, m: a rounding, what it leaves of face and side, a mark. Printers do not
/// resolve less, and the single precision of STL files still tells its ends apart.
pub const MIN_PART_M: f64 = 1e-5;

/// What both rims look like, where the faces meet the side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Edge {
    /// A right angle.
    Sharp,
    /// A quarter of a circle, tangent to face and side.
    Rounded {
        /// Its radius, m.
        radius_m: f64,
    },
    /// A cone at 45°.
    Chamfered {
        /// What it takes of the face's radius, and of half the thickness, m.
        size_m: f64,
    },
}

impl Edge {
    /// What the edge takes of the face's radius, and of half the thickness, m.
    ///
    /// ```
    /// use coinmc_solid::Edge;
    /// assert_eq!(Edge::Sharp.size_m(), 0.0);
    /// assert_eq!(Edge::Rounded { radius_m: 3e-4 }.size_m(), 3e-4);
    /// ```
    pub const fn size_m(self) -> f64 {
        match self {
            Self::Sharp => 0.0,
            Self::Rounded { radius_m } => radius_m,
            Self::Chamfered { size_m } => size_m,
        }
    }
}

/// A coin: a cylinder, or with a draft the frustum of a cone, with its axis along z, heads up. The origin is
/// halfway between the faces: the centre of mass, unless there is a draft.
///
/// All that this type holds can be made: its measures have been checked.
///
/// # Example
/// ```
/// use coinmc_solid::{Edge, Marks, Shape};
/// let plain = Shape::new(0.02325, 0.00233, Edge::Rounded { radius_m: 3e-4 })?;
/// let marked = plain.with_marks(Marks::fitting(&plain))?;
/// assert!(marked.volume_m3() < plain.volume_m3());
/// assert!(Shape::new(0.02, 0.002, Edge::Chamfered { size_m: 0.001 }).is_err());
/// # Ok::<(), coinmc_solid::ShapeError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    diameter_m: f64,
    thickness_m: f64,
    edge: Edge,
    draft_deg: f64,
    marks: Option<Marks>,
}

impl Shape {
    /// A coin without marks.
    ///
    /// # Errors
    /// [`ShapeError::Size`] unless both measures are from [`MIN_SIZE_M`] to [`MAX_SIZE_M`].
    /// [`ShapeError::Edge`] unless the edge takes at least [`MIN_PART_M`] and leaves as much of the
    /// face's radius and of half the side.
    pub fn new(diameter_m: f64, thickness_m: f64, edge: Edge) -> Result<Self, ShapeError> {
        for (what, found) in [("diameter", diameter_m), ("thickness", thickness_m)] {
            if !(MIN_SIZE_M..=MAX_SIZE_M).contains(&found) {
                let (least, most) = (MIN_SIZE_M, MAX_SIZE_M);
                return Err(ShapeError::Size {
                    what,
                    found,
                    least,
                    most,
                });
            }
        }
        let most = diameter_m.min(thickness_m) / 2.0 - MIN_PART_M;
        if edge != Edge::Sharp && !(MIN_PART_M..=most).contains(&edge.size_m()) {
            let (found, least) = (edge.size_m(), MIN_PART_M);
            return Err(ShapeError::Edge { found, least, most });
        }
        Ok(Self {
            diameter_m,
            thickness_m,
            edge,
            draft_deg: 0.0,
            marks: None,
        })
    }

    /// The same coin with its side at the angle `draft_deg` (degrees) to the axis: a conical edge. Above 0
    /// heads is the wider face, below 0 tails; the diameter is that of the wider face.
    ///
    /// # Errors
    /// [`ShapeError::DraftedEdge`] unless the rims are sharp, [`ShapeError::DraftedMarks`] if it has marks;
    /// [`ShapeError::Draft`] unless the angle takes at least [`MIN_PART_M`] of the narrower face's radius and
    /// leaves as much.
    ///
    /// # Example
    /// ```
    /// use coinmc_solid::{Edge, Shape};
    /// let coin = Shape::new(0.02, 0.008, Edge::Sharp)?.with_draft(10.0)?;
    /// let [heads, tails] = coin.face_radii_m();
    /// assert_eq!(heads, 0.01);
    /// assert!((heads - tails - 0.008 * 10.0_f64.to_radians().tan()).abs() < 1e-15);
    /// // its centre of mass is nearer to heads, the wider face
    /// assert!(coin.centre_m() > 0.0);
    /// # Ok::<(), coinmc_solid::ShapeError>(())
    /// ```
    pub fn with_draft(self, draft_deg: f64) -> Result<Self, ShapeError> {
        if draft_deg == 0.0 {
            return Ok(Self { draft_deg, ..self });
        }
        if self.edge != Edge::Sharp {
            return Err(ShapeError::DraftedEdge);
        }
        if self.marks.is_some() {
            return Err(ShapeError::DraftedMarks);
        }
        let [least, most] = [MIN_PART_M, self.radius_m() - MIN_PART_M].map(|taken| {
            let slope = taken / self.thickness_m;
            libm::atan(slope).to_degrees()
        });
        if !(least..=most).contains(&draft_deg.abs()) {
            return Err(ShapeError::Draft {
                found: draft_deg,
                least,
                most,
            });
        }
        Ok(Self { draft_deg, ..self })
    }

    /// The same coin with marks.
    ///
    /// # Errors
    /// [`ShapeError::MarkDepth`] unless the depth is at least [`MIN_PART_M`] and less than a quarter of
    /// the thickness. [`ShapeError::MarkRadii`] unless the axis, the inner radius, the outer one and
    /// that of the flat face follow each other in steps of at least [`MIN_PART_M`].
    /// [`ShapeError::DraftedMarks`] if the edge is conical.
    pub fn with_marks(self, marks: Marks) -> Result<Self, ShapeError> {
        if self.draft_deg != 0.0 {
            return Err(ShapeError::DraftedMarks);
        }
        let Marks {
            inner_m: inner,
            outer_m: outer,
            depth_m: found,
        } = marks;
        let limit = self.thickness_m / 4.0;
        let (face, least) = (self.face_radius_m(), MIN_PART_M);
        if !(found >= least && found < limit) {
            return Err(ShapeError::MarkDepth {
                found,
                least,
                limit,
            });
        }
        if !(inner >= least && outer >= inner + least && face >= outer + least) {
            return Err(ShapeError::MarkRadii {
                inner,
                outer,
                face,
                least,
            });
        }
        Ok(Self {
            marks: Some(marks),
            ..self
        })
    }

    /// Diameter 2R over the side, m; of the wider face if there is a draft.
    pub const fn diameter_m(&self) -> f64 {
        self.diameter_m
    }

    /// Thickness H from face to face, m.
    pub const fn thickness_m(&self) -> f64 {
        self.thickness_m
    }

    /// The rims.
    pub const fn edge(&self) -> Edge {
        self.edge
    }

    /// The angle of the side with the axis, degrees: above 0 heads is the wider face.
    pub const fn draft_deg(&self) -> f64 {
        self.draft_deg
    }

    /// The marks on the faces.
    pub const fn marks(&self) -> Option<Marks> {
        self.marks
    }

    /// R, m.
    pub const fn radius_m(&self) -> f64 {
        self.diameter_m / 2.0
    }

    /// Radius of the flat part of a face, m; of the wider one if there is a draft.
    pub const fn face_radius_m(&self) -> f64 {
        self.radius_m() - self.edge.size_m()
    }

    /// Radii of the flat parts of heads and of tails, m.
    pub fn face_radii_m(&self) -> [f64; 2] {
        let wide = self.face_radius_m();
        let narrow = wide - self.thickness_m * libm::tan(self.draft_deg.abs().to_radians());
        if self.draft_deg < 0.0 {
            [narrow, wide]
        } else if self.draft_deg > 0.0 {
            [wide, narrow]
        } else {
            [wide; 2]
        }
    }
}
