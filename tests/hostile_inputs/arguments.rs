//! Invalid arguments: exit code 2, with the found and the allowed values in the message.

use super::common::program;
use super::{assert_says, refused_with};

#[test]
fn invalid_arguments_are_rejected_with_code_2() {
    for (arguments, parts) in [
        (&["run"][..], &["<SCENARIO>"][..]),
        (&["fly"], &["unrecognized subcommand 'fly'"]),
        (
            &["run", "smoke", "--speed"],
            &["unexpected argument '--speed'"],
        ),
        (
            &["run", "smoke", "--seed", "-1"],
            &["invalid value '-1' for '--seed"],
        ),
        (
            &["run", "smoke", "--seed", "18446744073709551616"],
            &["18446744073709551616", "--seed"],
        ),
        (
            &["run", "smoke", "--threads", "1025"],
            &["1025 is not in 0..=1024"],
        ),
        (
            &["run", "smoke", "--format", "xml"],
            &["'xml'", "text, json"],
        ),
        (
            &["run", "smoke", "--keep", "0"],
            &["found \"0\"; allowed: thinned, all, none, or a number"],
        ),
        (
            &["run", "smoke", "--keep", "some"],
            &["found \"some\"; allowed: thinned, all, none"],
        ),
        (&["resume"], &["<RUN_DIR>"]),
        (&["evaluate", "smoke"], &["--tree <TREE>"]),
        (
            &["evaluate", "smoke", "--tree", "x", "--repeats", "0"],
            &["0 is not in 1..=100000"],
        ),
        (
            &["evaluate", "smoke", "--tree", "x", "--primitive-sets", "0"],
            &["0 is not in 1..=10000"],
        ),
        (
            &["evaluate", "smoke", "--tree", "x", "--trials", "0"],
            &["0 is not in 1..=100000"],
        ),
        (&["tree", "diff", "x"], &["<B>"]),
        (&["completions", "cmd"], &["'cmd'", "bash"]),
    ] {
        let said = refused_with(2, program().args(arguments));
        assert_says(&said, parts);
    }
}

#[test]
fn arguments_that_are_not_utf8_are_rejected() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    let bytes = OsStr::from_bytes(b"\xff\xfe\x1b[31m");
    refused_with(2, program().arg("run").arg(bytes));
    refused_with(2, program().arg(bytes));
    // A path may contain any bytes.
    refused_with(1, program().arg("resume").arg(bytes));
}
