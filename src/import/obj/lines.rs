//! Text to statements: line ends of every system, continuations, comments.

use std::borrow::Cow;

/// A statement with the line that it begins on, from 1.
pub(super) struct Statement<'a> {
    pub line: usize,
    /// Its first word.
    pub keyword: &'a str,
    /// What follows, without blanks around.
    pub rest: &'a str,
}

/// The text of a file: bytes that are not UTF-8 (they occur in names and
/// comments only) are replaced, a byte order mark goes.
pub(super) fn text(bytes: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))
}

/// Calls `read` with every statement, in order, until it fails.
///
/// A `\` at the end of a line joins the next one to it, unless the line is a
/// comment: that would hide a statement.
pub(super) fn each_statement<E>(
    text: &str,
    mut read: impl FnMut(Statement) -> Result<(), E>,
) -> Result<(), E> {
    let end = if text.contains('\n') { '\n' } else { '\r' };
    let mut lines = text.split(end).map(str::trim).zip(1..);
    while let Some((first, line)) = lines.next() {
        let mut joined = Cow::Borrowed(first);
        while !joined.starts_with('#')
            && let Some(begun) = joined.strip_suffix('\\')
        {
            let more = lines.next().map_or("", |(more, _)| more);
            joined = Cow::Owned(format!("{} {more}", begun.trim_end()));
        }
        let (keyword, rest) = joined
            .split_once(char::is_whitespace)
            .unwrap_or((&joined, ""));
        if !keyword.is_empty() && !keyword.starts_with('#') {
            read(Statement {
                line,
                keyword,
                rest: rest.trim(),
            })?;
        }
    }
    Ok(())
}

/// The words of a statement up to a comment.
pub(super) fn words(rest: &str) -> impl Iterator<Item = &str> {
    rest.split_whitespace()
        .take_while(|word| !word.starts_with('#'))
}

/// Parses a number that is finite and in the range of `f32`.
pub(super) fn number(word: &str) -> Result<f64, String> {
    let fault = match word.parse::<f64>() {
        Ok(number) if super::super::in_range(number) => return Ok(number),
        Ok(number) if number.is_nan() => "is not a finite number",
        Ok(_) => "is beyond the range of 32-bit floats",
        Err(_) => "is not a number",
    };
    Err(format!("`{}` {fault}", super::super::shown(word)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn statements(text: &str) -> Vec<(usize, String)> {
        let mut all = Vec::new();
        let end: Result<(), ()> = each_statement(text, |statement| {
            all.push((
                statement.line,
                format!("{}|{}", statement.keyword, statement.rest),
            ));
            Ok(())
        });
        assert!(end.is_ok());
        all
    }

    #[test]
    fn continuations_keep_the_line_of_their_beginning() {
        let expected = [
            (1, "v|1 2 3".to_owned()),
            (4, "f|1".to_owned()),
            (6, "g|a".to_owned()),
        ];
        assert_eq!(
            statements("v 1 \\\n 2 \\ \r\n  3\r\nf 1\n# \\\ng a\\"),
            expected
        );
    }

    #[test]
    fn every_line_end_separates() {
        for text in ["v\t1\ng", "v 1\r\ng", "v 1 \rg"] {
            assert_eq!(
                statements(text),
                [(1, "v|1".to_owned()), (2, "g|".to_owned())]
            );
        }
    }

    #[test]
    fn numbers_are_finite() {
        assert_eq!(number("-1.5e3"), Ok(-1500.0));
        for word in ["nan", "inf", "1e39", "1,5", "0x1", ""] {
            assert!(number(word).is_err(), "{word}");
        }
    }
}
