//! Which instructions do several numbers at once, chosen when the program runs.
//!
//! No result depends on them: lanes either do the same operations in the same order, or tests that only say
//! where to look closer.

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
pub(crate) use fearless_simd::Fallback as Baseline;
use fearless_simd::Level;
#[cfg(target_arch = "aarch64")]
pub(crate) use fearless_simd::aarch64::Neon as Baseline;
#[cfg(target_arch = "x86_64")]
pub(crate) use fearless_simd::x86::{Avx2, Avx512, Sse2 as Baseline};

/// The instructions.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Lanes {
    /// Those that every processor of the kind has.
    Baseline(Baseline),
    /// AVX2, where the processor has it: eight lanes in one.
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    /// AVX-512, where the processor has it: sixteen lanes in one. It has AVX2, too, which is used where sixteen are too many.
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512, Avx2),
}

impl Lanes {
    /// The widest that this processor has.
    pub(crate) fn widest() -> Lanes {
        let level = Level::new();
        #[cfg(target_arch = "x86_64")]
        match (level.as_avx512(), level.as_avx2()) {
            (Some(avx512), Some(avx2)) => return Lanes::Avx512(avx512, avx2),
            (None, Some(avx2)) => return Lanes::Avx2(avx2),
            (_, None) => {}
        }
        Lanes::baseline(level)
    }

    /// All that this processor has, narrow ones first.
    #[cfg(test)]
    pub(crate) fn all() -> Vec<Lanes> {
        let level = Level::new();
        let all = std::iter::once(Lanes::baseline(level));
        #[cfg(target_arch = "x86_64")]
        let all = all.chain(level.as_avx2().map(Lanes::Avx2));
        #[cfg(target_arch = "x86_64")]
        let all = all.chain(matches!(Lanes::widest(), Lanes::Avx512(..)).then(Lanes::widest));
        all.collect()
    }

    #[cfg(target_arch = "x86_64")]
    fn baseline(level: Level) -> Lanes {
        Lanes::Baseline(level.as_sse2().expect("x86-64 has SSE2"))
    }

    #[cfg(target_arch = "aarch64")]
    fn baseline(level: Level) -> Lanes {
        Lanes::Baseline(level.as_neon().expect("AArch64 has NEON"))
    }

    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    fn baseline(_: Level) -> Lanes {
        Lanes::Baseline(Baseline::new())
    }
}

/// Evaluates an expression with the token of the chosen instructions, of those that do at most eight numbers at once.
macro_rules! with_lanes {
    ($lanes:expr, $simd:ident => $what:expr) => {
        match $lanes {
            $crate::lanes::Lanes::Baseline($simd) => $what,
            #[cfg(target_arch = "x86_64")]
            $crate::lanes::Lanes::Avx2($simd) | $crate::lanes::Lanes::Avx512(_, $simd) => $what,
        }
    };
}

/// Evaluates an expression with the token of the chosen instructions.
macro_rules! with_widest_lanes {
    ($lanes:expr, $simd:ident => $what:expr) => {
        match $lanes {
            $crate::lanes::Lanes::Baseline($simd) => $what,
            #[cfg(target_arch = "x86_64")]
            $crate::lanes::Lanes::Avx2($simd) => $what,
            #[cfg(target_arch = "x86_64")]
            $crate::lanes::Lanes::Avx512($simd, _) => $what,
        }
    };
}
pub(crate) use {with_lanes, with_widest_lanes};
