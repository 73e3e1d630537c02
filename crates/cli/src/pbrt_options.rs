//! pbrt's command lines: its spellings, and those of its options that tenfold does not have.

use crate::failure::Failure;
use clap::Command;
use std::ffi::{OsStr, OsString};

/// Options of pbrt-v4 that change how it works but not what it computes, and whether a value follows.
const WITHOUT_EFFECT: [(&str, bool); 4] =
    [("gpu", false), ("gpu-device", true), ("render-coord-sys", true), ("wavefront", false)];

/// Options of pbrt-v4 that tenfold does not have, and what to do instead.
const ABSENT: [(&str, &str); 14] = [
    ("debugstart", "--pixel X,Y renders one pixel alone"),
    ("disable-pixel-jitter", "--freeze pixel samples pixels at their centres"),
    ("disable-wavelength-jitter", "--freeze wavelength renders in the light of one wavelength"),
    ("displacement-edge-scale", "displacement is not supported"),
    ("display-server", "--progress json tells other programs how far a render is"),
    ("force-diffuse", "materials are always those of the scene"),
    ("format", "tenfold renders scenes and does not rewrite them"),
    ("log-file", "--log LEVEL writes to standard error, which the shell can send to a file"),
    ("mse-reference-image", "compare the pictures afterwards"),
    ("mse-reference-out", "compare the pictures afterwards"),
    ("pixelmaterial", "--pixel X,Y renders one pixel alone"),
    ("pixelstats", "--stats prints the totals"),
    ("toply", "tenfold renders scenes and does not rewrite them"),
    ("upgrade", "tenfold renders scenes and does not rewrite them: pbrt-v4 itself upgrades pbrt-v3's"),
];

/// Accepted too, with a note: the render's end and Ctrl-C are the times when pictures are written.
const PARTIAL: &str = "write-partial-images";

/// A command line in tenfold's own spelling.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Translated {
    /// The arguments.
    pub(crate) argv: Vec<OsString>,
    /// What to tell the user.
    pub(crate) notes: Vec<String>,
}

/// Rewrites a command line: leaves out a leading `render`, turns `-spp` into `--spp` and `--cropwindow 0 1 0 1` into
/// `--cropwindow 0,1,0,1`, and deals with options that only pbrt has.
pub(crate) fn translate(argv: Vec<OsString>, command: &Command) -> Result<Translated, Failure> {
    let known: Vec<&str> = command.get_arguments().filter_map(|a| a.get_long()).collect();
    let mut out = Translated::default();
    let mut rest = argv.into_iter().peekable();
    rest.next_if(|arg| arg == "render");
    while let Some(arg) = rest.next() {
        if arg == "--" {
            out.argv.push(arg);
            out.argv.extend(rest);
            break;
        }
        let Some((name, value)) = option_name(&arg) else {
            out.argv.push(arg);
            continue;
        };
        if let Some((_, what)) = ABSENT.iter().find(|(absent, _)| *absent == name) {
            return Err(Failure::Wrong(format!("pbrt's option --{name} does not exist here: {what}")));
        }
        if let Some((_, takes_value)) = WITHOUT_EFFECT.iter().find(|(absent, _)| *absent == name) {
            out.notes.push(format!("--{name} does not change the picture and has no effect here"));
            if *takes_value && value.is_none() {
                rest.next();
            }
            continue;
        }
        if name == PARTIAL {
            out.notes
                .push(format!("--{PARTIAL} has no effect: pictures are written at the end or at Ctrl-C"));
            continue;
        }
        if arg.to_string_lossy().starts_with("--") || !(known.contains(&name.as_str()) || name == "log-level")
        {
            out.argv.push(arg);
        } else {
            let mut long = OsString::from("-");
            long.push(&arg);
            out.argv.push(long);
        }
        let numbers = match name.as_str() {
            "cropwindow" | "pixelbounds" => 4,
            "pixel" => 2,
            _ => continue,
        };
        if value.is_none() {
            let mut list: Vec<String> = Vec::new();
            while list.len() < numbers {
                let Some(number) = rest.next_if(is_number) else { break };
                list.push(number.to_string_lossy().into_owned());
            }
            if !list.is_empty() {
                out.argv.push(list.join(",").into());
            }
        }
    }
    Ok(out)
}

/// The name of a long option, written with one dash or two, and its value, where it is in the same argument.
fn option_name(arg: &OsStr) -> Option<(String, Option<String>)> {
    let text = arg.to_str()?;
    let bare = text.strip_prefix("--").or_else(|| text.strip_prefix('-'))?;
    let (name, value) = match bare.split_once('=') {
        Some((name, value)) => (name, Some(value.to_owned())),
        None => (bare, None),
    };
    (name.len() > 1).then(|| (name.to_owned(), value))
}

fn is_number(arg: &OsString) -> bool {
    arg.to_str().is_some_and(|text| text.parse::<f32>().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::Args;
    use clap::CommandFactory;

    fn translated(line: &str) -> Result<(String, usize), Failure> {
        let argv = line.split_whitespace().map(OsString::from).collect();
        let out = translate(argv, &Args::command())?;
        let words: Vec<_> = out.argv.iter().map(|a| a.to_string_lossy()).collect();
        Ok((words.join(" "), out.notes.len()))
    }

    #[test]
    fn pbrts_spellings_become_ours() {
        let same = |line: &str| assert_eq!(translated(line).unwrap(), (line.to_owned(), 0));
        same("-o a.exr --spp 4 scene.pbrt -q");
        same("--pixel 1,2");
        same("- --seed 3 -- --gpu");
        assert_eq!(translated("render -spp 4 render").unwrap().0, "--spp 4 render");
        assert_eq!(translated("--cropwindow 0 0.5 0 1 a.pbrt").unwrap().0, "--cropwindow 0,0.5,0,1 a.pbrt");
        assert_eq!(translated("--pixelbounds -1 5 0 9").unwrap().0, "--pixelbounds -1,5,0,9");
        assert_eq!(translated("--gpu --render-coord-sys world a.pbrt").unwrap(), ("a.pbrt".to_owned(), 2));
    }

    #[test]
    fn pbrts_other_options_are_named() {
        let failure = translated("--mse-reference-image a.exr").unwrap_err();
        assert!(failure.code() == 2 && failure.message().contains("--mse-reference-image"));
    }
}
