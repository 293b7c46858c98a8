//! A page in one file, with the player, its modules and a clip in it: a browser that has the page shows the figure, without a further request.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pantin::Clip;

use crate::site::{FACE, PLAYER};

/// What plays key clips.
const KEYS: &str = "pantin-keys.js";

/// Writes the page of a clip, from a site that was built. A clip with scalars gets what draws a face, too, and a key clip what plays its keys. What is loaded later,
/// such as the script that saves pictures, is looked for beside the page.
pub fn page(site: &Path, clip: &[u8], title: &str) -> Result<String> {
    let opened = Clip::new_checked(clip).map_err(|error| anyhow::anyhow!("{error}"))?;
    let has_scalars = opened.rig().channels() > opened.rig().joint_channels();
    let read = |name: &str| std::fs::read(site.join(name)).with_context(|| name.to_owned());
    let script = |name: &str| String::from_utf8(read(name)?).context("a script that is not UTF-8");
    let mut player = script(PLAYER[0])?;
    let mut before = String::new();
    for (name, variable, wanted) in [(FACE[0], "pantinFace", has_scalars), (KEYS, "pantinKeys", opened.has_keys())] {
        if !wanted {
            continue;
        }
        let import = format!("import(\"./{name}\")");
        ensure!(player.contains(&import), "no {import}");
        before += &format!(
            "const {variable}=URL.createObjectURL(new Blob([Uint8Array.from(`{}`,letter=>letter.charCodeAt())],{{type:\"text/javascript\"}}));",
            text(&read(name)?)
        );
        player = player.replace(&import, &format!("import({variable})"));
    }
    ensure!(!player.contains("</"), "{}: a tag in the script ends it", PLAYER[0]);
    let title: String = title.chars().filter(|letter| !"<>&".contains(*letter)).collect();
    Ok(format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<pantin-player src=\"data:;base64,{}\" autoplay loop></pantin-player>\n\
         <script type=\"module\">{before}{player}</script>\n</html>\n",
        STANDARD.encode(clip)
    ))
}

/// Bytes as the letters of a template literal in a page, each modulo 256: brotli makes hardly more of them than of the bytes, and a third more of base64.
pub(crate) fn text(bytes: &[u8]) -> String {
    let letter = |&byte: &u8| {
        // Letters that a page or a literal takes for something else, or changes.
        let high = if b"\0\n\r<\\`$".contains(&byte) { 0x100 } else { 0 };
        char::from_u32(u32::from(byte) + high).unwrap_or_default()
    };
    bytes.iter().map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::text;

    #[test]
    fn bytes_come_back() {
        let bytes: Vec<u8> = (0..=255).collect();
        let text = text(&bytes);
        assert_eq!(text.chars().map(|letter| letter as u32 as u8).collect::<Vec<_>>(), bytes);
        assert!(!text.contains(['\0', '\n', '\r', '<', '\\', '`', '$']));
    }
}
