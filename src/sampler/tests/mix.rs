use super::statistics::fits;
use super::{plane, sampler};
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::roadmap::Configs;
use crate::sampler::{Mix, Sampler, Share};
use crate::seed::Seed;

#[test]
fn mixed_samplers_have_their_weights_and_their_own_streams() {
    let Mix(shares) = Mix(vec![
        Share { weight: 1.0, sampler: sampler("uniform = {}") },
        Share { weight: 2.5, sampler: sampler("halton = {}") },
        Share { weight: 0.5, sampler: sampler("gaussian = { deviation = 0.3 }") },
    ]);
    let mix = Mix(shares.clone());
    let mut counts = [0; 3];
    for ordinal in 0..80 {
        let seed = Seed::of_set(7, "mix", Ordinal(ordinal));
        let drawn = mix.counts(&seed, 50);
        assert_eq!(drawn.iter().sum::<usize>(), 50);
        counts.iter_mut().zip(drawn).for_each(|(count, drawn)| *count += drawn);
    }
    fits(&counts, &[1.0, 2.5, 0.5]);

    let cx = plane(4.0, 4.0, &[[1.0, 1.0, 1.0, 1.0]]);
    let seed = Seed::of_set(7, "mix", Ordinal(3));
    let (mut whole, mut parts) = (Configs::new(2), Configs::new(2));
    mix.sample(&cx, &seed, 50, &mut Scratch::new(), &mut whole).unwrap();
    for (index, (share, count)) in shares.iter().zip(mix.counts(&seed, 50)).enumerate() {
        let seed = seed.part(index as u64);
        let method = share.sampler.method();
        method.sample(&cx, &seed, count, &mut Scratch::new(), &mut parts).unwrap();
    }
    assert_eq!(whole, parts);
}
