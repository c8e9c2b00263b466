//! What becomes of a bias as the step shrinks.

/// Bias that is asked for.
const ASKED: f64 = 0.005;

/// Standard errors of a two-sided 95 %.
const SIGMAS: f64 = 1.96;

/// Steps, s, that the line is fitted to: those at which the bias is nearly proportional to the
/// step.
const SMALL: f64 = 2e-3;

/// A bias at one step, s, and its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    pub(super) step: f64,
    pub(super) bias: f64,
    pub(super) error: f64,
}

impl Cell {
    /// |bias| is at most this, at 95 %.
    pub(super) fn bound(&self) -> f64 {
        self.bias.abs() + SIGMAS * self.error
    }
}

/// The line bias = limit + slope·step through cells, weighted by their errors.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Line {
    limit: f64,
    error: f64,
    /// Sum of squared deviations in standard errors, and how many cells there are beyond two.
    chi_square: f64,
    freedom: usize,
}

impl Line {
    /// `None` of fewer than three cells.
    fn through(cells: &[Cell]) -> Option<Self> {
        let freedom = cells.len().checked_sub(2).filter(|freedom| *freedom > 0)?;
        let sum = |of: fn(&Cell) -> f64| -> f64 {
            cells
                .iter()
                .map(|cell| of(cell) / (cell.error * cell.error))
                .sum()
        };
        let (w, s, ss) = (sum(|_| 1.0), sum(|c| c.step), sum(|c| c.step * c.step));
        let (b, sb) = (sum(|c| c.bias), sum(|c| c.step * c.bias));
        let determinant = w * ss - s * s;
        let (limit, slope) = (
            (ss * b - s * sb) / determinant,
            (w * sb - s * b) / determinant,
        );
        let deviation = |cell: &Cell| (cell.bias - limit - slope * cell.step) / cell.error;
        limit.is_finite().then(|| Self {
            limit,
            error: (ss / determinant).sqrt(),
            chi_square: cells.iter().map(|cell| deviation(cell).powi(2)).sum(),
            freedom,
        })
    }
}

/// In words: where the bias asked for is established, where it can be ruled out, and its limit.
pub(super) fn summary(cells: &[Cell]) -> String {
    let steps = |holds: fn(&Cell) -> bool| -> String {
        let which = cells.iter().filter(|cell| holds(cell));
        let which: Vec<String> = which.map(|cell| format!("{:.0e}", cell.step)).collect();
        if which.is_empty() {
            "no step".to_owned()
        } else {
            which.join(" ")
        }
    };
    let least = cells.iter().min_by(|a, b| a.bound().total_cmp(&b.bound()));
    let least = least.map_or(String::new(), |cell| {
        format!("; least bound {:.4} at {:.0e} s", cell.bound(), cell.step)
    });
    let small: Vec<Cell> = cells
        .iter()
        .copied()
        .filter(|cell| cell.step <= SMALL)
        .collect();
    let limit = Line::through(&small).map_or(String::new(), |line| {
        format!(
            "; line through steps up to {SMALL:.0e} s: {:+.4} ± {:.4} at step 0 (chi2 {:.1} of {})",
            line.limit, line.error, line.chi_square, line.freedom
        )
    });
    format!(
        "|bias| < {ASKED} at 95 % at {}; > {ASKED} at 95 % at {}{least}{limit}",
        steps(|cell| cell.bound() < ASKED),
        steps(|cell| cell.bias.abs() - SIGMAS * cell.error > ASKED),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_again() {
        let cell = |step: f64, error: f64| Cell {
            step,
            bias: 0.01 - 3.0 * step,
            error,
        };
        let line = Line::through(&[cell(1e-4, 1e-3), cell(5e-4, 2e-3), cell(2e-3, 5e-4)]).unwrap();
        assert!(
            (line.limit - 0.01).abs() < 1e-12 && line.chi_square < 1e-12,
            "{line:?}"
        );
        assert_eq!(line.freedom, 1);
        assert!(line.error > 5e-4 && line.error < 2e-3, "{line:?}");
        assert_eq!(Line::through(&[cell(1e-4, 1e-3), cell(5e-4, 1e-3)]), None);
    }

    #[test]
    fn what_is_established_is_told_from_what_is_ruled_out_and_from_what_is_open() {
        let cells = [
            (2e-2, 0.1, 0.01),
            (1e-3, 0.004, 0.002),
            (1e-4, 0.001, 0.001),
        ];
        let cells = cells.map(|(step, bias, error)| Cell { step, bias, error });
        let text = summary(&cells);
        assert!(
            text.contains("at 95 % at 1e-4; > 0.005 at 95 % at 2e-2; least bound 0.0030"),
            "{text}"
        );
    }
}
