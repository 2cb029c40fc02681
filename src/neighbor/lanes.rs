//! Which instructions measure sixteen points or boxes at once, chosen when the program runs.
//!
//! Every lane does the same operations of single precision in the same order, none of them fused, so that
//! squares have the same bits whatever the instructions.

/// The instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lanes {
    /// Those that the program was built for.
    Baseline,
    /// AVX2, where the processor has it: eight lanes in one. AVX-512 gained nothing more.
    #[cfg(target_arch = "x86_64")]
    Avx2,
}

impl Lanes {
    /// The widest that this processor has.
    pub(super) fn widest() -> Lanes {
        Lanes::all().pop().unwrap_or(Lanes::Baseline)
    }

    /// All that this processor has, narrow ones first.
    pub(super) fn all() -> Vec<Lanes> {
        let mut all = vec![Lanes::Baseline];
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            all.push(Lanes::Avx2);
        }
        all
    }
}
