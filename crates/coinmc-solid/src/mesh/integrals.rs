//! Volume, centre and inertia of a mesh as a solid of density one.
//!
//! Every triangle (a, b, c) spans a tetrahedron with the origin, of the volume det(a, b, c)/6 with the
//! sign of its side. The sum over a closed surface is the integral over the solid. Over one tetrahedron of
//! volume v, with s = a + b + c,
//!
//! ∫x_i dV = v s_i/4,  ∫x_i x_j dV = v (a_i a_j + b_i b_j + c_i c_j + s_i s_j)/20.
//!
//! F. Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor in terms of its vertex
//! coordinates", Journal of Mathematics and Statistics 1 (2005) 8–11; for any polyhedron: B. Mirtich,
//! "Fast and accurate computation of polyhedral mass properties", Journal of Graphics Tools 1 (1996)
//! 31–50.

use super::Mesh;

/// ∫dV, ∫x_i dV and ∫x_i x_j dV.
#[derive(Default)]
struct Integrals {
    volume: f64,
    first: [f64; 3],
    second: [[f64; 3]; 3],
}

impl Integrals {
    fn of(mesh: &Mesh) -> Self {
        let mut sum = Self::default();
        for [a, b, c] in mesh.corners() {
            sum.add(a, b, c);
        }
        sum
    }

    /// Adds the tetrahedron of a triangle and the origin.
    fn add(&mut self, a: [f64; 3], b: [f64; 3], c: [f64; 3]) {
        let volume = dot(a, cross(b, c)) / 6.0;
        self.volume += volume;
        for i in 0..3 {
            let s_i = a[i] + b[i] + c[i];
            self.first[i] += volume * s_i / 4.0;
            for j in 0..3 {
                let s_j = a[j] + b[j] + c[j];
                let products = a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + s_i * s_j;
                self.second[i][j] += volume * products / 20.0;
            }
        }
    }

    fn centre(&self) -> [f64; 3] {
        self.first.map(|first| first / self.volume)
    }
}

impl Mesh {
    /// The enclosed volume, m³.
    pub fn volume_m3(&self) -> f64 {
        Integrals::of(self).volume
    }

    /// The centre of mass of the enclosed solid, m.
    pub fn centre_m(&self) -> [f64; 3] {
        Integrals::of(self).centre()
    }

    /// The inertia tensor of the enclosed solid about its centre of mass over density, m⁵:
    /// ∫(r² δ_ij − x_i x_j) dV.
    pub fn inertia_m5(&self) -> [[f64; 3]; 3] {
        let sum = Integrals::of(self);
        let centre = sum.centre();
        // ∫(x − c)_i (x − c)_j dV = ∫x_i x_j dV − V c_i c_j
        let about = |i: usize, j: usize| sum.second[i][j] - sum.volume * centre[i] * centre[j];
        let trace: f64 = (0..3).map(|i| about(i, i)).sum();
        let entry = |i: usize, j: usize| {
            if i == j {
                trace - about(i, i)
            } else {
                -about(i, j)
            }
        };
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product: twice the area of a triangle with these sides, along its normal.
pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::super::tests::cuboid;

    /// A box away from the origin: its centre, and m(b² + c²)/12.
    #[test]
    fn a_box_has_the_moments_of_a_box() {
        let (low, [a, b, c]) = ([3.0, -5.0, 7.0], [1.0, 2.0, 4.0]);
        let mesh = cuboid(low, [a, b, c]);
        let volume = a * b * c;
        assert!((mesh.volume_m3() - volume).abs() < 1e-12);
        for (found, expected) in mesh.centre_m().into_iter().zip([3.5, -4.0, 9.0]) {
            assert!((found - expected).abs() < 1e-12);
        }
        let diagonal = [b * b + c * c, c * c + a * a, a * a + b * b].map(|x| volume * x / 12.0);
        for (i, row) in mesh.inertia_m5().into_iter().enumerate() {
            for (j, found) in row.into_iter().enumerate() {
                let expected = if i == j { diagonal[i] } else { 0.0 };
                assert!((found - expected).abs() < 1e-10, "{i} {j}");
            }
        }
    }

    /// The corner of a cube cut off along its diagonals: ∫xy dV = 1/120, the centre at 1/4, 1/6 of
    /// volume. So the product of inertia about the centre is 1/6/16 − 1/120.
    #[test]
    fn products_of_inertia_have_their_sign() {
        let mut mesh = cuboid([0.0; 3], [1.0; 3]);
        mesh.vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        mesh.triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        assert!(mesh.is_watertight());
        let expected = 1.0 / 96.0 - 1.0 / 120.0;
        assert!((mesh.inertia_m5()[0][1] - expected).abs() < 1e-15);
    }
}
