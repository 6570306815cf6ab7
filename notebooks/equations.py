"""Equations of a page, typeset beforehand by MathJax: the page then needs no script, no font and no network.

MathJax 3 runs in a small JavaScript engine inside of Python. Each equation becomes an SVG in the size and colour of the
text, as in JupyterLab, and MathML for screen readers, with the TeX source. Letters are drawn once a page, and used
wherever they stand.
"""

import html
import re
from importlib.resources import files

from uavlab.requirements import require

PARTS = ("startup", "core", "adaptors/liteDOM", "input/tex-full", "output/svg", "output/svg/fonts/tex")
BEGIN = """
var { mathjax, adaptors, core, handlers, input, output } = MathJax._;
var adaptor = adaptors.liteAdaptor.liteAdaptor();
handlers.html_ts.RegisterHTMLHandler(adaptor);
var tex = new input.tex_ts.TeX({
  packages: ["base", "ams", "newcommand", "boldsymbol"],
  formatError: (_, problem) => { throw problem; },
});
var svg = new output.svg_ts.SVG({ fontCache: "global", font: new output.svg.fonts.tex_ts.TeXFont() });
var page = mathjax.mathjax.document("", { InputJax: tex, OutputJax: svg });
var speech = new core.MmlTree.SerializedMmlVisitor.SerializedMmlVisitor();
var typeset = (source, display) => {
  var equation = new page.options.MathItem(source, tex, display);
  equation.setMetrics(16, 8, 1280, 1e6, 1);
  try {
    equation.compile(page);
  } catch (problem) {
    return { problem: problem.message };
  }
  equation.typeset(page);
  adaptor.setAttribute(adaptor.firstChild(equation.typesetRoot), "aria-hidden", "true");
  return { picture: adaptor.outerHTML(equation.typesetRoot), spoken: speech.visitTree(equation.root) };
};
"""
UNUSED = re.compile(r' (?:data-mml-node|data-c|data-mjx-texclass|xmlns:xlink|xmlns|role|focusable)="[^"]*"')
"""Attributes of MathJax's that a page without its script has no use for."""
UNKNOWN = re.compile(r"<text[^>]*>([^<]+)</text>")
"""A letter that MathJax's font doesn't have; it would have no width."""
STYLE = """
mjx-container { position: relative; white-space: nowrap; }
mjx-container > svg { overflow: visible; min-width: 1px; min-height: 1px; max-width: none !important; }
.jp-RenderedMarkdown { overflow: auto hidden; /* on a phone tables and long equations keep their size, too */ }
mjx-container[display] { display: block; margin: 1em 0; padding: 2px 0; text-align: center; overflow: auto hidden; }
mjx-container[width] { min-width: 0 !important; /* a long one with a number is scrolled, too */ }
mjx-container math { position: absolute; top: 0; left: 0; width: 1px; height: 1px; overflow: hidden; }
mjx-container math { clip-path: inset(50%); }
"""


class Equations:
    """The equations of one page."""

    style = STYLE

    def __init__(self) -> None:
        self.engine = require("dukpy", "pages").JSInterpreter()
        require("mathjax", "pages")
        for part in PARTS:
            script = (files("mathjax") / f"static/mathjax/es5/{part}.js").read_text(encoding="utf-8")
            self.engine.evaljs(f"{script}; null")
        self.engine.evaljs(f"{BEGIN}; null")

    def typeset(self, tex: str, display: bool) -> str:
        """HTML of an equation; `ValueError` if TeX doesn't understand it."""
        made = self.engine.evaljs("typeset(dukpy.tex, dukpy.display)", tex=tex, display=display)
        if "problem" in made:
            raise ValueError(f"{made['problem']} in the equation {tex.strip()}")
        if unknown := UNKNOWN.search(made["picture"]):
            raise ValueError(f"There is no letter {unknown[1]} for the equation {tex.strip()}")
        spoken = re.sub(r' id="[^"]*"', "", re.sub(r"\n\s*", "", made["spoken"]))  # the picture has them
        spoken = spoken.replace("<math", f'<math alttext="{html.escape(tex.strip())}"', 1)
        return UNUSED.sub("", made["picture"].replace("</mjx-container>", f"{spoken}</mjx-container>"))

    def letters(self) -> str:
        """What all equations so far are made of; it has to stand in their page."""
        shapes = self.engine.evaljs("adaptor.outerHTML(svg.fontCache.getCache())")
        return f'<svg width="0" height="0" style="position:absolute" aria-hidden="true">{shapes}</svg>'
