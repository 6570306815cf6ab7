"""Commands for meshcat's viewer, kept and packed into one page that needs no server."""

from __future__ import annotations

import base64
import gzip
import html
from functools import lru_cache
from importlib.resources import files
from typing import Any

import umsgpack


class CommandRecorder:
    """Stands where meshcat expects its window to the server: keeps the commands, and packs them into a page."""

    def __init__(self) -> None:
        self.commands: dict[tuple[str, str], bytes] = {}
        self.names: dict[str, str] = {}

    def send(self, command: Any) -> None:
        """Keep a command; a later one for the same thing replaces it."""
        lowered = command.lower()
        kind = lowered["type"] + lowered.get("property", "")
        self.commands[lowered["path"], kind] = umsgpack.packb(self.stable(lowered))

    def stable(self, value: Any) -> Any:
        """The same value with random identifiers replaced by a count, so that the same scene gives the same bytes."""
        if isinstance(value, dict):
            return {key: self.stable(item) for key, item in value.items()}
        if isinstance(value, list):
            return [self.stable(item) for item in value]
        if isinstance(value, str) and len(value) == 36 and value.count("-") == 4:
            return self.names.setdefault(value, f"id{len(self.names)}")
        return value

    def page(self, title: str, caption: str) -> str:
        """The whole page; the animation comes last, when all that it moves is there."""
        ordered = sorted(self.commands.items(), key=lambda item: item[0][1] == "set_animation")
        packed = b"".join(len(command).to_bytes(4, "big") + command for _, command in ordered)
        return PAGE.format(title=html.escape(title), legend=caption, viewer=viewer_script(), commands=compress(packed))


@lru_cache(1)
def viewer_script() -> str:
    return compress(files("meshcat").joinpath("viewer/dist/main.min.js").read_bytes())


def compress(content: bytes) -> str:
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode()


PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>
body{{margin:0;font:13px/1.5 system-ui,sans-serif}}
#pane{{width:100vw;height:100vh;overflow:hidden}}
#legend{{position:absolute;left:8px;bottom:8px;padding:4px 10px;background:rgba(255,255,255,.85);border-radius:4px}}
.dg.main{{display:none}}
</style></head><body><div id="pane"></div><div id="legend">{legend}</div><script>
const unpack = async text => {{
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}};
(async () => {{
  const script = document.createElement("script");
  script.textContent = new TextDecoder().decode(await unpack("{viewer}"));
  document.head.appendChild(script);
  const commands = new Uint8Array(await unpack("{commands}")), view = new DataView(commands.buffer);
  const viewer = window.viewer = new MeshCat.Viewer(document.getElementById("pane"));
  for (let at = 0; at < commands.length;) {{
    const length = view.getUint32(at);
    viewer.handle_command_bytearray(commands.slice(at + 4, at + 4 + length));
    at += 4 + length;
  }}
  viewer.set_3d_pane_size();
  document.body.dataset.ready = "yes";
}})().catch(error => {{
  document.getElementById("legend").append(" — this browser can't draw the scene: " + error.message);
}});
</script></body></html>
"""
