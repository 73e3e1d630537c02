//! The directives of the current transforms, and of the keys of motion.

use super::{Parser, Reported, Token, TokenKind, state::Active};
use crate::Diagnostic;
use tenfold_math::{Mat4, Transform, Vec3};

impl Parser<'_> {
    pub(super) fn transform(&mut self, token: &Token) -> Result<(), Reported> {
        let replaces = matches!(token.text.as_str(), "Identity" | "Transform");
        let transform = match token.text.as_str() {
            "Identity" => Some(Transform::IDENTITY),
            "Translate" => Some(Transform::translate(Vec3::from(self.numbers::<3>(token)?))),
            "Scale" => Transform::scale(Vec3::from(self.numbers::<3>(token)?)),
            "Rotate" => {
                let [degrees, x, y, z] = self.numbers::<4>(token)?;
                Transform::rotate(degrees.to_radians(), Vec3::new(x, y, z))
            }
            "LookAt" => {
                let v = self.numbers::<9>(token)?;
                let [eye, look, up] = [0, 3, 6].map(|i| Vec3::from_slice(&v[i..]));
                Transform::look_at(eye, look, up)
            }
            _ => {
                self.bracket(TokenKind::Open, token)?;
                // The file has the columns one after the other.
                let matrix = Mat4::from_cols_array(&self.numbers::<16>(token)?);
                self.bracket(TokenKind::Close, token)?;
                Transform::from_mat4(matrix)
            }
        };
        let span = token.span.to(self.last);
        let Some(transform) = transform else {
            let why = match token.text.as_str() {
                "Scale" => "Scale by zero has no inverse",
                "Rotate" => "Rotate needs an axis that is not zero",
                "LookAt" => {
                    "LookAt needs an eye away from the point looked at, and an up direction aside from the view"
                }
                _ => "this matrix is not affine (its last row is not 0 0 0 1) or has no inverse",
            };
            return self.fail(span, why.to_owned());
        };
        self.builder.transform(span, |current| if replaces { transform } else { current * transform });
        Ok(())
    }

    fn bracket(&mut self, kind: TokenKind, directive: &Token) -> Result<(), Reported> {
        let name = if kind == TokenKind::Open { "`[`" } else { "`]`" };
        let token = self.required(name, directive)?;
        if token.kind == kind {
            return Ok(());
        }
        let message =
            format!("{} needs 16 numbers in brackets, found {} for {name}", directive.text, token.shown());
        let span = token.span;
        self.stream.hold(token);
        self.fail(span, message)
    }

    /// The times of the keys: two numbers, as in pbrt, or two and more in brackets.
    pub(super) fn transform_times(&mut self, directive: &Token) -> Result<(), Reported> {
        let first = self.required("2 numbers, or times in brackets", directive)?;
        if first.kind != TokenKind::Open {
            self.stream.hold(first);
            let times = self.numbers::<2>(directive)?;
            let span = directive.span.to(self.last);
            if times[1] <= times[0] {
                self.diagnostics.warning(span, "the second time is not after the first: nothing will move");
            }
            self.builder.set_transform_times(times.to_vec(), span);
            return Ok(());
        }
        let mut times: Vec<f32> = Vec::new();
        loop {
            let token = self.required("`]`", directive)?;
            if token.kind == TokenKind::Close {
                break;
            }
            let time =
                self.number(&token, || format!("TransformTimes needs numbers, found {}", token.shown()))?;
            if let Some(before) = times.last().filter(|before| time <= **before) {
                let message = format!("the times of keys must increase: {time} is not after {before}");
                return self.fail(token.span, message);
            }
            times.push(time);
        }
        let span = directive.span.to(self.last);
        if times.len() < 2 {
            return self.fail(span, format!("TransformTimes needs 2 times or more, found {}", times.len()));
        }
        self.builder.set_transform_times(times, span);
        Ok(())
    }

    /// Which keys the transforms to come belong to: all, the first, the last, or one by its index.
    pub(super) fn active_transform(&mut self, directive: &Token) -> Result<(), Reported> {
        let which = self.required("All, StartTime, EndTime or the index of a key", directive)?;
        let keys = self.builder.key_count();
        let active = match (which.text.as_str(), which.text.parse()) {
            ("All", _) => Active::All,
            ("StartTime", _) => Active::Key(0),
            ("EndTime", _) => Active::Key(keys - 1),
            (_, Ok(key)) if key < keys => Active::Key(key),
            (text, Ok(_)) => {
                let message =
                    format!("there is no key {text}: the {keys} keys have indices 0 to {}", keys - 1);
                let error = Diagnostic::error(which.span, message);
                self.diagnostics
                    .push(error.with_help("TransformTimes [ t0 t1 t2 ] gives times to more keys"));
                return Ok(());
            }
            _ => {
                let message = format!(
                    "ActiveTransform needs All, StartTime, EndTime or the index of a key, found {}",
                    which.shown()
                );
                let error = Diagnostic::error(which.span, message);
                self.diagnostics.push(error.with_nearest(&which.text, ["All", "StartTime", "EndTime"]));
                self.stream.hold(which);
                return Err(Reported);
            }
        };
        self.builder.activate(active, directive.span.to(which.span));
        Ok(())
    }
}
