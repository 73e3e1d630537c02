//! Names for variables that go together.

use crate::Variable;

/// Variables with a name for all of them.
const GROUPS: [(&str, &[Variable]); 2] = [
    ("light", &[Variable::LightChoice, Variable::LightPoint]),
    ("scatter", &[Variable::ScatterLobe, Variable::ScatterDirection]),
];

impl Variable {
    /// The variables that `name` stands for: one by its own name, or a group of them. `None` where there are none.
    ///
    /// ```
    /// use tenfold_sampling::Variable;
    ///
    /// assert_eq!(Variable::named("lens"), Some(&[Variable::Lens][..]));
    /// assert_eq!(Variable::named("light"), Some(&[Variable::LightChoice, Variable::LightPoint][..]));
    /// assert_eq!(Variable::named("lans"), None);
    /// ```
    pub fn named(name: &str) -> Option<&'static [Self]> {
        const ALL: &[Variable] = &Variable::ALL;
        let single = ALL.iter().position(|v| v.name() == name).map(|i| &ALL[i..=i]);
        single.or_else(|| GROUPS.iter().find(|(group, _)| *group == name).map(|(_, variables)| *variables))
    }

    /// All names that [`Variable::named`] knows.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::ALL.into_iter().map(Self::name).chain(GROUPS.map(|(group, _)| group))
    }

    /// Whether it chooses between alternatives, and is not a point, a direction, a time or the like. Held in the
    /// middle it leaves one alternative, and the others are gone from the picture.
    pub const fn is_choice(self) -> bool {
        matches!(
            self,
            Self::Hero
                | Self::LightChoice
                | Self::ScatterLobe
                | Self::MaterialMix
                | Self::Alpha
                | Self::Roulette
                | Self::MediumEvent
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn names_are_distinct_and_known() {
        let names: Vec<_> = Variable::names().collect();
        assert_eq!(names.iter().collect::<HashSet<_>>().len(), names.len());
        assert!(names.iter().all(|name| Variable::named(name).is_some_and(|v| !v.is_empty())));
    }
}
