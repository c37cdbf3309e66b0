//! Legs with several local minima, which the first two starts do not tell apart.

use slewplan_solver::model::spec::{
    AttitudeSpec, ScenarioSpec, SpacecraftSpec, StateSpec, TargetSpec,
};
use slewplan_tests::general;
use slewplan_tests::solving::plan_of;
use slewplan_tests::wheel;

/// Relative excess over the best known duration that is accepted.
const ACCEPTED: f64 = 1e-3;

/// A body with three equal wheels: inertia, their axes, the spin inertia, torque and speed of each,
/// and the attitudes at the two ends.
struct Skew {
    inertia: [[f64; 3]; 3],
    axes: [[f64; 3]; 3],
    wheel: [f64; 3],
    ends: [[f64; 4]; 2],
}

impl Skew {
    fn spec(&self) -> ScenarioSpec {
        let [inertia, torque, speed] = self.wheel;
        let [start, target] = self.ends.map(AttitudeSpec::Quaternion);
        ScenarioSpec {
            spacecraft: SpacecraftSpec {
                inertia_kg_m2: self.inertia,
                wheels: self
                    .axes
                    .map(|axis| wheel(axis, inertia, torque, speed))
                    .into(),
                ..SpacecraftSpec::default()
            },
            start: StateSpec {
                attitude: start,
                ..StateSpec::default()
            },
            targets: vec![TargetSpec {
                id: "there".to_owned(),
                attitude: target,
                ..TargetSpec::default()
            }],
            ..ScenarioSpec::default()
        }
    }
}

fn assert_minimum(spec: &ScenarioSpec, best_s: f64) {
    let plan = plan_of(spec);
    let duration = plan.legs[0].duration_s;
    assert!(
        duration <= best_s * (1.0 + ACCEPTED),
        "{duration} s, best known {best_s} s"
    );
    let bound = plan.legs[0].certified_lower_bound_s.expect("a bound");
    assert!(bound <= duration);
}

/// The first two starts end at 27.90 s.
#[test]
fn a_slew_with_three_skew_wheels_leads_away_from_the_eigenaxis() {
    let slew = Skew {
        inertia: [
            [10.919_019_1, 0.252_228_981, 0.891_064_545],
            [0.252_228_981, 12.761_881_4, 1.685_639_44],
            [0.891_064_545, 1.685_639_44, 9.607_119_95],
        ],
        axes: [
            [0.577_619_971, -0.217_363_881, -0.786_834_234],
            [0.151_029_595, -0.422_902_122, 0.893_500_899],
            [-0.759_254_757, -0.627_790_826, -0.171_496_044],
        ],
        wheel: [0.002_598_523_94, 0.175_040_128, 348.454_587],
        ends: [
            [
                -0.631_161_050_978,
                -0.410_088_303_3,
                -0.207_419_517_356,
                -0.624_852_346_594,
            ],
            [
                -0.055_155_697_57,
                -0.231_878_942_105,
                0.511_016_188_955,
                -0.825_864_674_06,
            ],
        ],
    };
    assert_minimum(&slew.spec(), 25.76);
}

/// The first two starts end at 243.97 s.
#[test]
fn a_slow_slew_with_three_skew_wheels_leads_away_from_the_eigenaxis() {
    let slew = Skew {
        inertia: [
            [84.953_25, -10.933_694_5, -7.607_876_93],
            [-10.933_694_5, 78.486_332_5, -1.138_797_83],
            [-7.607_876_93, -1.138_797_83, 97.970_382_8],
        ],
        axes: [
            [-0.613_431_396, -0.517_998_751, -0.596_136_911],
            [-0.269_537_741, 0.817_950_701, -0.508_238_189],
            [-0.989_433_965, -0.089_732_475, 0.113_879_37],
        ],
        wheel: [0.001_750_813_66, 0.543_171_208, 475.042_964],
        ends: [
            [
                0.602_629_787_283,
                0.782_700_167_785,
                -0.074_745_858_278,
                0.136_494_847_886,
            ],
            [
                0.823_580_258_181,
                -0.407_415_816_993,
                -0.270_203_052_393,
                0.287_607_755_242,
            ],
        ],
    };
    assert_minimum(&slew.spec(), 232.99);
}

/// The first two starts end 3 to 9 % later.
#[test]
fn general_slews_with_several_minima_reach_the_best_known_one() {
    for (number, best_s) in [(173, 117.686), (187, 68.595), (193, 67.583)] {
        assert_minimum(&general::slew(2, number), best_s);
    }
}

/// Wheels near their limits favour a side, and a way round: the first two starts, and the long way about its
/// eigenaxis, end 4 to 57 % later.
#[test]
fn loaded_slews_with_several_minima_reach_the_best_known_one() {
    let slews = [
        (2, 22, 109.72),
        (2, 388, 28.19),
        (3, 118, 54.27),
        (3, 120, 76.86),
        (3, 246, 54.83),
    ];
    for (seed, number, best_s) in slews {
        assert_minimum(&general::loaded_slew(seed, number), best_s);
    }
}
