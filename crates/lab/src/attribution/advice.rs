use super::{Attribution, Group};

/// Groups below this total share get no advice.
const WORTH_MENTION: f64 = 0.1;

impl Attribution {
    /// What follows from the shares, in sentences, the most important first.
    pub fn advice(&self) -> Vec<String> {
        let percent = |share: f64| format!("{:.0} %", 100.0 * share.clamp(0.0, 1.0));
        if self.groups.is_empty() || self.totals.variance().value <= 0.0 {
            return vec!["There is no noise: every sample of a pixel gives the same.".to_owned()];
        }
        let alone = 1.0 - self.totals.interactions().value;
        let mut out = vec![if alone >= 0.5 {
            format!(
                "{} of the variance is the variables' own, one by one: samplers that spread the numbers of each evenly take it away, \
                 the default among them. These shares are of independent samples; where that is the sampler, change it first.",
                percent(alone)
            )
        } else {
            format!(
                "Only {} of the variance is the variables' own, one by one: that is what a sampler takes away which spreads each evenly. \
                 The rest comes from variables together, and needs more samples, or samples drawn better.",
                percent(alone)
            )
        }];
        let mut blamed: Vec<(Group, f64, f64)> = (0..self.groups.len())
            .map(|i| (self.groups[i], self.totals.first_order(i).value, self.totals.total(i).value))
            .filter(|&(_, _, total)| total >= WORTH_MENTION)
            .collect();
        blamed.sort_by(|a, b| b.2.total_cmp(&a.2));
        for (group, first, total) in blamed {
            let how = if first >= 0.5 * total {
                format!(
                    "{} of it by itself, which an even spread of its numbers removes",
                    percent(first / total)
                )
            } else {
                format!(
                    "but {} of it together with others, which no spread of its numbers alone removes",
                    percent(1.0 - first / total)
                )
            };
            out.push(format!(
                "{}: {} of the variance, {how}. {}",
                group.name(),
                percent(total),
                remedy(group)
            ));
        }
        out
    }
}

/// What can be done about a group.
fn remedy(group: Group) -> &'static str {
    match group {
        Group::Pixel => {
            "Edges and fine detail within pixels: more samples for the pixels at edges; where it is a texture, one that is filtered."
        }
        Group::Lens => {
            "What is far out of focus: more samples for blurred parts, with a sampler that is even in two dimensions (zsobol, \
             multi-jittered)."
        }
        Group::Time => {
            "What moves: more samples for blurred parts. It is one number: with an even spread (n-rooks, zsobol) its own part falls fastest \
             of all."
        }
        Group::Wavelength => {
            "Colours drawn as wavelengths, and glass that parts them: an even spread of the wavelengths; light through prisms needs samples."
        }
        Group::Light => {
            "The light that is chosen and the point on it: fewer or smaller lights, or a better strategy for them; penumbrae need samples."
        }
        Group::Scatter => {
            "The direction a path takes: glossy reflections, and light that arrives by way of other surfaces. More samples; where small bright \
             things are found by chance, make them lights of the scene's, which are aimed at."
        }
        Group::Mix => "Materials mixed by chance: a blend of their textures instead has no noise.",
        Group::Alpha => "Surfaces that are partly there: masks of 0 and 1 have less noise.",
        Group::Roulette => {
            "Paths that end by chance: it is the price of speed where paths are long and dark."
        }
        Group::Medium => "Fog and the like: more samples.",
    }
}
