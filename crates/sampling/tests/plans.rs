//! Plans: a sampler for each variable, variables held, streams.

use tenfold_math::{UVec2, Vec2};
use tenfold_sampling::{Dimension, Draw, SamplePlan, Sampler, SamplerKind, Variable};

const PIXEL: UVec2 = UVec2::new(12, 34);

#[test]
fn each_variable_is_drawn_as_by_its_own_sampler_alone() {
    let mut plan = SamplePlan::from(SamplerKind::ZSobol);
    plan.set(Variable::Lens, Draw::By(SamplerKind::NRooks));
    plan.set(Variable::Time, Draw::Held(Vec2::new(0.25, 0.75)));
    let planned = Sampler::new(plan, 16, 5);
    for index in [0, 3, 15, 16, 1000] {
        let sample = planned.at(PIXEL, index);
        for variable in Variable::ALL {
            let d = Dimension::new(variable, 2);
            let kind = match variable {
                Variable::Time => {
                    assert_eq!((sample.get_1d(d), sample.get_2d(d)), (0.25, Vec2::new(0.25, 0.75)));
                    assert_eq!(sample.hash(d), planned.at(UVec2::ZERO, 7).hash(d));
                    continue;
                }
                Variable::Lens => SamplerKind::NRooks,
                _ => SamplerKind::ZSobol,
            };
            let alone = Sampler::new(kind, 16, 5);
            let alone = alone.at(PIXEL, index);
            assert_eq!(
                (sample.get_1d(d), sample.get_2d(d), sample.hash(d)),
                (alone.get_1d(d), alone.get_2d(d), alone.hash(d)),
                "{variable:?} {index}"
            );
        }
    }
}

#[test]
fn streams_change_the_numbers_of_their_variable_alone() {
    let plain = SamplePlan::from(SamplerKind::ZSobol);
    let mut other = plain;
    other.set_stream(Variable::LightPoint, 3);
    let (a, b) = (Sampler::new(plain, 16, 5), Sampler::new(other, 16, 5));
    let (a, b) = (a.at(PIXEL, 4), b.at(PIXEL, 4));
    for variable in Variable::ALL {
        let d = Dimension::new(variable, 1);
        let same = variable != Variable::LightPoint;
        assert_eq!(a.get_2d(d) == b.get_2d(d), same, "{variable:?}");
        assert_eq!(a.hash(d) == b.hash(d), same, "{variable:?}");
    }
}

#[test]
fn plans_tell_what_differs() {
    let mut plan = SamplePlan::from(SamplerKind::ZSobol);
    assert_eq!(plan.to_string(), "zsobol");
    plan.set(Variable::Lens, Draw::By(SamplerKind::NRooks));
    plan.set(Variable::Time, Draw::Held(Vec2::splat(0.5)));
    assert_eq!(plan.to_string(), "zsobol, lens=n-rooks, time held at 0.5");
}
