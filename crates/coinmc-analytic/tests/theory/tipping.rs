//! An adhesive landing from its mechanics: lowest point, lever of the weight, fall.

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Rest {
    Heads,
    Tails,
    Side,
}

/// The rest of a coin of `R = 1` and the given height that touches the floor with its normal along
/// the unit vector `u` (z up): it tips about its lowest point, to the side of that point on which
/// its centre lies.
pub(crate) fn rest(height: f64, u: [f64; 3]) -> Rest {
    let lower_face = if u[2] > 0.0 {
        -0.5 * height
    } else {
        0.5 * height
    };
    let face_centre = u.map(|c| lower_face * c);
    // The steepest direction downwards in the plane of the face.
    let down = [u[0] * u[2], u[1] * u[2], u[2] * u[2] - 1.0];
    let length = down.iter().map(|c| c * c).sum::<f64>().sqrt();
    if length == 0.0 {
        return if u[2] > 0.0 { Rest::Heads } else { Rest::Tails };
    }
    let contact: [f64; 3] = std::array::from_fn(|i| face_centre[i] + down[i] / length);
    let to_centre = [-contact[0], -contact[1]];
    let to_face = [-down[0], -down[1]];
    if to_centre[0] * to_face[0] + to_centre[1] * to_face[1] <= 0.0 {
        Rest::Side
    } else if u[2] > 0.0 {
        Rest::Heads
    } else {
        Rest::Tails
    }
}

/// The same for a coin tilted by `theta` from heads up about a horizontal diameter.
pub(crate) fn rest_tilted(height: f64, theta: f64) -> Rest {
    rest(height, [libm::sin(theta), 0.0, libm::cos(theta)])
}
