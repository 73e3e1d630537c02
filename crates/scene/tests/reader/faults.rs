//! Broken scenes: every fault is one finding with its place, and what follows is still read.

use crate::{Files, read, read_with, world_findings};

/// Every scene and all that is to be found in it. The name of the file, `s`, is left out.
const SCENES: [(&str, &[&str]); 79] = [
    // Strings and files that break off.
    ("", &["1:1: error: the file ends without WorldBegin"]),
    ("Film \"rgb\"", &["1:11: error: the file ends without WorldBegin"]),
    ("WorldBegin Shape", &["1:12: error: the file ends where Shape needs a name"]),
    (
        "WorldBegin Shape \"sph\nShape \"disk\"",
        &["1:18: error: this string is not closed: strings end on the line where they begin"],
    ),
    (
        "WorldBegin Shape \"s\" \"float r",
        &["1:22: error: this string is not closed: strings end on the line where they begin"],
    ),
    ("WorldBegin Shape \"s\" \"float r\"", &["1:22: error: the file ends before the value of \"r\""]),
    (
        "WorldBegin Shape \"s\" \"point3 P\" [ 1 2",
        &["1:33: error: the file ends inside the list of values of \"P\""],
    ),
    ("WorldBegin Translate 1 2", &["1:12: error: the file ends where Translate needs 3 numbers"]),
    ("WorldBegin Texture \"a\" \"float\"", &["1:12: error: the file ends where Texture needs a name"]),
    ("WorldBegin Transform [ 1 0 0", &["1:12: error: the file ends where Transform needs 16 numbers"]),
    ("WorldBegin Include", &["1:12: error: the file ends where Include needs the name of a file"]),
    (
        "WorldBegin ActiveTransform",
        &[
            "1:12: error: the file ends where ActiveTransform needs All, StartTime, EndTime or the index of a key",
        ],
    ),
    (
        "Option \"seed\"\nWorldBegin",
        &[
            "2:1: error: option \"seed\" needs a number, found `WorldBegin`",
            "2:11: error: the file ends without WorldBegin",
        ],
    ),
    // Words.
    (
        "WorldBegin\nShpae \"sphere\" \"float radius\" 2",
        &["2:1: error: unknown directive `Shpae` (did you mean \"Shape\"?)"],
    ),
    (
        "WorldBegin worldbegin",
        &["1:12: error: unknown directive `worldbegin` (did you mean \"WorldBegin\"?)"],
    ),
    ("WorldBegin Teapot 1 2 3 \"x\" [ ] ] Shape \"s\"", &["1:12: error: unknown directive `Teapot`"]),
    ("WorldBegin Identity 3", &["1:21: error: expected a directive, found `3`"]),
    ("WorldBegin Shape \"s\" \"float r\" 1 2 3", &["1:34: error: expected a directive, found `2`"]),
    ("WorldBegin \"Shape\"", &["1:12: error: expected a directive, found the string \"Shape\""]),
    ("WorldBegin ] Shape \"s\"", &["1:12: error: expected a directive, found `]`"]),
    (
        "WorldBegin WorldEnd",
        &["1:12: error: pbrt-v4 has no WorldEnd (the world ends with the file: remove it)"],
    ),
    ("WorldBegin Shape sphere", &["1:18: error: Shape needs a name in quotes, found `sphere`"]),
    (
        "WorldBegin Shape AttributeBegin AttributeEnd",
        &["1:18: error: Shape needs a name in quotes, found `AttributeBegin`"],
    ),
    (
        "WorldBegin Shape \"s\" \"disk\"",
        &["1:22: error: a parameter's declaration needs a type and a name (as in \"float disk\")"],
    ),
    (
        "WorldBegin Shape \"s\" \"\"",
        &["1:22: error: a parameter's declaration needs a type and a name (as in \"float radius\")"],
    ),
    // Values.
    (
        "WorldBegin Shape \"s\" \"float r\" true",
        &["1:32: error: expected a number for parameter \"r\", found `true`"],
    ),
    (
        "WorldBegin Shape \"s\" \"float r\" nan",
        &["1:32: error: expected a number for parameter \"r\", found `nan`"],
    ),
    (
        "WorldBegin Shape \"s\" \"float r\" -inf",
        &["1:32: error: expected a number for parameter \"r\", found `-inf`"],
    ),
    (
        "WorldBegin Shape \"s\" \"float r\" 1e99",
        &["1:32: error: expected a number below 3.4e38 for parameter \"r\", found `1e99`"],
    ),
    (
        "WorldBegin Shape \"s\" \"float r\" \"x\" Shape \"t\"",
        &["1:32: error: expected a number for parameter \"r\", found the string \"x\""],
    ),
    (
        "WorldBegin Shape \"s\" \"float r\" [ 1 2,5 3 4,5 ]",
        &["1:36: error: expected a number for parameter \"r\", found `2,5`"],
    ),
    (
        "WorldBegin Shape \"s\" \"integer n\" 2.0",
        &["1:34: error: expected an integer for parameter \"n\", found `2.0` (write 2)"],
    ),
    (
        "WorldBegin Shape \"s\" \"integer n\" 2.5",
        &["1:34: error: expected an integer for parameter \"n\", found `2.5`"],
    ),
    (
        "WorldBegin Shape \"s\" \"integer n\" [ 1 3000000000 ]",
        &["1:38: error: expected an integer of 32 bits for parameter \"n\", found `3000000000`"],
    ),
    (
        "WorldBegin Shape \"s\" \"bool b\" 1",
        &["1:31: error: expected true or false for parameter \"b\", found `1`"],
    ),
    (
        "WorldBegin Shape \"s\" \"bool b\" True",
        &["1:31: error: expected true or false for parameter \"b\", found `True`"],
    ),
    (
        "WorldBegin Shape \"s\" \"string x\" y",
        &["1:33: error: expected a quoted string for parameter \"x\", found `y`"],
    ),
    (
        "WorldBegin Shape \"s\" \"texture x\" 3",
        &["1:34: error: expected a quoted string for parameter \"x\", found `3`"],
    ),
    (
        "WorldBegin Shape \"s\" \"spectrum x\" y",
        &["1:35: error: expected a quoted name or a number for parameter \"x\", found `y`"],
    ),
    (
        "WorldBegin Shape \"s\" \"spectrum x\" [ 400 1 \"a\" ]",
        &["1:43: error: expected a number for parameter \"x\", found the string \"a\""],
    ),
    (
        "WorldBegin Shape \"s\" \"float r\" ]",
        &["1:22: error: parameter \"r\" has no value", "1:32: error: expected a directive, found `]`"],
    ),
    ("WorldBegin Shape \"s\" \"float r\" \"float z\" 1", &["1:22: error: parameter \"r\" has no value"]),
    ("WorldBegin Shape \"s\" \"float r\" Shape \"t\"", &["1:22: error: parameter \"r\" has no value"]),
    (
        "WorldBegin Shape \"s\" \"float r\" [ 1 2 \"float z\" 1",
        &["1:32: error: the values of \"r\" have no closing `]`"],
    ),
    (
        "WorldBegin Shape \"s\" \"float r\" [ 1 2\nShape \"t\"",
        &["1:32: error: the values of \"r\" have no closing `]`"],
    ),
    ("WorldBegin Shape \"s\" \"float r\" [ [ 1 ] ]", &["1:34: error: `[` inside the values of \"r\""]),
    (
        "WorldBegin Shape \"s\" \"foo r\" [ 1 \"a\" true ] \"float x\" y",
        &[
            "1:22: error: unknown parameter type \"foo\"",
            "1:55: error: expected a number for parameter \"x\", found `y`",
        ],
    ),
    // Transforms.
    ("WorldBegin Scale 1 0 1", &["1:12: error: Scale by zero has no inverse"]),
    ("WorldBegin Rotate 30 0 0 0", &["1:12: error: Rotate needs an axis that is not zero"]),
    ("WorldBegin Rotate 30 0 0 Shape \"s\"", &["1:26: error: Rotate needs 4 numbers, found `Shape` after 3"]),
    ("WorldBegin Translate nan 0 0", &["1:22: error: Translate needs 3 numbers, found `nan` after 0"]),
    ("WorldBegin Translate 1e40 0 0", &["1:22: error: `1e40` is beyond the range of numbers"]),
    (
        "WorldBegin\n  LookAt 0 0 0 0 0 0 0 1 0",
        &[
            "2:3: error: LookAt needs an eye away from the point looked at, and an up direction aside from the view",
        ],
    ),
    (
        "WorldBegin Transform [ 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 ]",
        &["1:12: error: this matrix is not affine (its last row is not 0 0 0 1) or has no inverse"],
    ),
    (
        "WorldBegin Transform 1 0 0 0",
        &["1:22: error: Transform needs 16 numbers in brackets, found `1` for `[`"],
    ),
    (
        "WorldBegin ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0 ]",
        &["1:62: error: ConcatTransform needs 16 numbers in brackets, found `0` for `]`"],
    ),
    (
        "WorldBegin Scale 1e30 1e30 1e30 Scale 1e30 1e30 1e30",
        &["1:33: error: with this, the current transform leaves the range of numbers"],
    ),
    (
        "TransformTimes 1 1 WorldBegin",
        &["1:1: warning: the second time is not after the first: nothing will move"],
    ),
    (
        "TransformTimes 0 [ 1 ] WorldBegin",
        &["1:18: error: TransformTimes needs 2 numbers, found `[` after 1"],
    ),
    ("TransformTimes [ 1 ] WorldBegin", &["1:1: error: TransformTimes needs 2 times or more, found 1"]),
    ("TransformTimes [ ] WorldBegin", &["1:1: error: TransformTimes needs 2 times or more, found 0"]),
    (
        "TransformTimes [ 0 0.5 0.5 ] WorldBegin",
        &["1:24: error: the times of keys must increase: 0.5 is not after 0.5"],
    ),
    (
        "TransformTimes [ 0 1 \"2\" ] WorldBegin",
        &["1:22: error: TransformTimes needs numbers, found the string \"2\""],
    ),
    ("WorldBegin TransformTimes [ 0 1 ", &["1:12: error: the file ends where TransformTimes needs `]`"]),
    (
        "TransformTimes [ 0 1 2 ] ActiveTransform 3 WorldBegin ActiveTransform 2 ActiveTransform -1",
        &[
            "1:42: error: there is no key 3: the 3 keys have indices 0 to 2 (TransformTimes [ t0 t1 t2 ] gives times to more keys)",
            "1:89: error: ActiveTransform needs All, StartTime, EndTime or the index of a key, found `-1`",
        ],
    ),
    (
        "ActiveTransform EndTime Translate 1 0 0 TransformTimes [ 0 1 2 ] TransformTimes 0 2 WorldBegin",
        &["1:41: error: TransformTimes with 3 keys after ActiveTransform told 2 apart"],
    ),
    (
        "WorldBegin ActiveTransform Endtime",
        &[
            "1:28: error: ActiveTransform needs All, StartTime, EndTime or the index of a key, found `Endtime` (did you mean \"EndTime\"?)",
        ],
    ),
    // Order and nesting.
    (
        "WorldBegin Film \"rgb\" Camera \"perspective\" WorldBegin TransformTimes 0 1",
        &[
            "1:12: error: Film is allowed before WorldBegin only",
            "1:23: error: Camera is allowed before WorldBegin only",
            "1:44: error: WorldBegin is allowed before WorldBegin only",
            "1:55: error: TransformTimes is allowed before WorldBegin only",
        ],
    ),
    ("Shape \"s\" Shape \"t\" WorldBegin", &["1:1: error: Shape is allowed after WorldBegin only"]),
    ("Import \"x\" WorldBegin", &["1:1: error: Import is allowed after WorldBegin only"]),
    (
        "WorldBegin AttributeEnd ObjectEnd",
        &["1:12: error: AttributeEnd closes nothing", "1:25: error: ObjectEnd closes nothing"],
    ),
    (
        "WorldBegin AttributeBegin ObjectBegin \"o\"",
        &[
            "1:27: error: ObjectBegin has no ObjectEnd in this file",
            "1:12: error: AttributeBegin has no AttributeEnd in this file",
        ],
    ),
    (
        "WorldBegin ObjectBegin \"o\" AttributeEnd ObjectEnd",
        &["1:28: error: AttributeEnd inside an object's definition closes nothing"],
    ),
    (
        "WorldBegin ObjectBegin \"o\" AttributeBegin ObjectEnd",
        &["1:43: error: ObjectEnd before the end of an attribute scope"],
    ),
    (
        "WorldBegin ObjectBegin \"o\" ObjectBegin \"p\" ObjectEnd ObjectInstance \"o\" ObjectEnd",
        &[
            "1:28: error: ObjectBegin inside an object's definition",
            "1:54: error: ObjectInstance inside an object's definition",
        ],
    ),
    // Names.
    (
        "WorldBegin NamedMaterial \"glod\" MakeNamedMaterial \"gold\" \"string type\" \"conductor\" Shape \"s\"",
        &["1:26: error: material \"glod\" is not defined (did you mean \"gold\"?)"],
    ),
    ("WorldBegin NamedMaterial \"a\"", &["1:26: warning: material \"a\" is not defined"]),
    (
        "WorldBegin MediumInterface \"fog\" \"fog\" Shape \"s\" ObjectInstance \"tree\"",
        &["1:28: error: medium \"fog\" is not defined", "1:65: error: object \"tree\" is not defined"],
    ),
    (
        "WorldBegin CoordSysTransform \"wrold\"",
        &[
            "1:30: warning: coordinate system \"wrold\" is not defined: the directive does nothing (did you mean \"world\"?)",
        ],
    ),
];

#[test]
fn every_fault_is_found_at_its_place() {
    for (text, want) in SCENES {
        let found = read(text).1;
        let want: Vec<_> = want.iter().map(|line| format!("s:{line}")).collect();
        assert_eq!(found, want, "{text}");
    }
}

#[test]
fn further_faults_of_definitions() {
    for (text, want) in [
        ("ColorSpace \"srbg\"", "unknown colour space \"srbg\" (did you mean \"srgb\"?)"),
        (
            "ColorSpace \"prophoto\"",
            "unknown colour space \"prophoto\" (the known ones are srgb, dci-p3, rec2020, aces2065-1)",
        ),
        (
            "Attribute \"shapes\" \"float r\" 1",
            "unknown target \"shapes\" of Attribute: it is one of shape, light, material, medium, texture (did you mean \"shape\"?)",
        ),
        (
            "Texture \"t\" \"color\" \"constant\"",
            "textures give \"float\" or \"spectrum\", not \"color\" (pbrt-v4 writes \"spectrum\")",
        ),
        ("Option \"sede\" 1", "unknown option \"sede\" (did you mean \"seed\"?)"),
        (
            "Option \"forcediffuse\" \"true\"",
            "option \"forcediffuse\" needs true or false, without quotes, found the string \"true\"",
        ),
        ("MakeNamedMaterial \"m\"", "material \"m\" has no parameter \"string type\""),
        (
            "MakeNamedMedium \"m\" \"integer type\" 1",
            "the parameter \"type\" of medium \"m\" must be one string",
        ),
        (
            "Texture \"t\" \"float\" \"constant\" Texture \"t\" \"float\" \"scale\"",
            "texture \"t\" is defined twice",
        ),
        (
            "MakeNamedMaterial \"m\" \"string type\" \"mix\" MakeNamedMaterial \"m\" \"string type\" \"mix\"",
            "material \"m\" is defined twice",
        ),
        (
            "MakeNamedMedium \"m\" \"string type\" \"x\" MakeNamedMedium \"m\"",
            "medium \"m\" is defined twice",
        ),
        (
            "ObjectBegin \"m\" ObjectEnd ObjectBegin \"m\" Shape \"s\" ObjectEnd",
            "object \"m\" is defined twice",
        ),
    ] {
        let found = world_findings(text);
        assert_eq!(found.len(), 1, "{text}: {found:?}");
        let (_, message) = found[0].split_once(": error: ").unwrap();
        assert_eq!(message, want);
    }
}

#[test]
fn a_second_film_replaces_the_first_with_a_warning() {
    let (d, found) = read("Film \"gbuffer\"\nFilm \"rgb\"\nCamera \"a\" Camera \"b\" WorldBegin");
    assert_eq!(
        found,
        [
            "s:2:1: warning: this Film replaces an earlier one",
            "s:3:12: warning: this Camera replaces an earlier one"
        ]
    );
    assert_eq!(d.film.unwrap().kind, "rgb");
}

#[test]
fn what_follows_a_fault_is_read() {
    let (d, found) = read(
        "WorldBegin\nShape \"a\" \"float r\" [ 1 x ]\nRotate 1 2\nShape \"b\" \"float r\" 2\nFoo \"x\" 3\nShape \"c\"",
    );
    assert_eq!(found.len(), 3, "{found:?}");
    let kinds: Vec<_> = d.shapes.iter().map(|s| s.entity.kind.as_str()).collect();
    assert_eq!(kinds, ["a", "b", "c"]);
}

#[test]
fn imports_cannot_close_what_they_did_not_open() {
    let files = Files::new([("i", "AttributeEnd\nObjectEnd\nAttributeBegin\n")]);
    let (d, found) =
        read_with(&files, "WorldBegin ObjectBegin \"o\" AttributeBegin Import \"i\" AttributeEnd ObjectEnd");
    assert_eq!(
        found,
        [
            "i:1:1: error: AttributeEnd closes nothing",
            "i:2:1: error: ObjectEnd closes nothing",
            "i:3:1: error: AttributeBegin has no AttributeEnd in this file",
        ]
    );
    assert_eq!(d.objects.len(), 1);
}

#[test]
fn floods_of_faults_stay_readable() {
    let (_, found) = read(&("WorldBegin ".to_owned() + &"Shape 3 ".repeat(100_000)));
    assert_eq!(found.len(), 100);
    // Scopes without end cost memory: there is a limit.
    let (_, found) = read(&("WorldBegin ".to_owned() + &"AttributeBegin ".repeat(100_000)));
    assert!(found[0].contains("scopes lie in each other more than 65536 deep"), "{}", found[0]);
}
