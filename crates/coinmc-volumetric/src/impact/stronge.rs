/// (Seam.)
#[derive(Debug, Clone, Copy)]
pub struct Stronge;
