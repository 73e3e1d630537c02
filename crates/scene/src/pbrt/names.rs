//! Things that are defined once, some by name, and may be referred to before.

use crate::{Diagnostic, Diagnostics, Span};
use std::collections::HashMap;
use tenfold_math::Id;

/// A growing list of `T`s, some of which are named.
pub(super) struct Names<T> {
    slots: Vec<Slot<T>>,
    ids: HashMap<String, Id<T>>,
}

struct Slot<T> {
    value: Option<T>,
    /// The definition, or else the first reference.
    span: Span,
    /// Whether something in the scene depends on it.
    needed: bool,
}

impl<T> Names<T> {
    pub(super) fn new() -> Self {
        Self { slots: Vec::new(), ids: HashMap::new() }
    }

    fn push(&mut self, value: Option<T>, span: Span) -> Id<T> {
        self.slots.push(Slot { value, span, needed: false });
        Id::new(self.slots.len() - 1)
    }

    /// Adds something without a name.
    pub(super) fn add(&mut self, value: T, span: Span) -> Id<T> {
        self.push(Some(value), span)
    }

    /// Where a name was defined before.
    pub(super) fn definition(&self, name: &str) -> Option<Span> {
        let slot = &self.slots[self.ids.get(name)?.index()];
        slot.value.is_some().then_some(slot.span)
    }

    /// Defines a name; a second definition is ignored.
    pub(super) fn define(&mut self, name: &str, value: T, span: Span) {
        let id = self.refer(name, span);
        let slot = &mut self.slots[id.index()];
        if slot.value.is_none() {
            slot.value = Some(value);
            slot.span = span;
        }
    }

    /// The id of a name, which may be defined later.
    pub(super) fn refer(&mut self, name: &str, span: Span) -> Id<T> {
        if let Some(&id) = self.ids.get(name) {
            return id;
        }
        let id = self.push(None, span);
        self.ids.insert(name.to_owned(), id);
        id
    }

    /// Says that the scene depends on something.
    pub(super) fn need(&mut self, id: Id<T>) {
        self.slots[id.index()].needed = true;
    }

    /// The list, with a stand-in for everything that was never defined, and the names of what was; names without a
    /// definition are reported, as errors where the scene depends on them.
    pub(super) fn finish(
        self,
        what: &str,
        diagnostics: &Diagnostics,
        stand_in: impl Fn(&str, Span) -> T,
    ) -> (Vec<T>, HashMap<String, Id<T>>) {
        let (mut undefined, defined): (Vec<_>, HashMap<_, _>) = {
            let (undefined, defined): (Vec<_>, Vec<_>) =
                self.ids.into_iter().partition(|(_, id)| self.slots[id.index()].value.is_none());
            (undefined, defined.into_iter().collect())
        };
        undefined.sort_by_key(|(_, id)| *id);
        let mut slots = self.slots;
        let mut known: Vec<&str> = defined.keys().map(String::as_str).collect();
        known.sort_unstable();
        for (name, id) in undefined {
            let slot = &mut slots[id.index()];
            let message = format!("{what} \"{name}\" is not defined");
            let found = if slot.needed {
                Diagnostic::error(slot.span, message)
            } else {
                Diagnostic::warning(slot.span, message)
            };
            diagnostics.push(found.with_nearest(&name, known.iter().copied()));
            slot.value = Some(stand_in(&name, slot.span));
        }
        (slots.into_iter().filter_map(|slot| slot.value).collect(), defined)
    }
}
