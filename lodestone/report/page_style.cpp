#include "lodestone/report/page_style_detail.h"

namespace lodestone::report::detail {

const std::string_view kPageStyle = R"css(
:root { color-scheme: light dark; --paper: #fbfbfa; --card: #ffffff; --ink: #1c2026; --soft: #5b6470; --line: #dfe2e6;
  --accent: #0b63a8; --c0: #0b63a8; --c1: #c2410c; --c2: #15803d; --c3: #7e22ce; --c4: #a16207; --c5: #be185d; --warn: #fff6e0; }
@media (prefers-color-scheme: dark) { :root { --paper: #14171b; --card: #1c2026; --ink: #e8eaed; --soft: #a3abb5; --line: #343a42;
  --accent: #7cc0f8; --c0: #7cc0f8; --c1: #fb923c; --c2: #6ee7a0; --c3: #d0a5fb; --c4: #e6c15a; --c5: #f58ac0; --warn: #33290f; } }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
@media (prefers-reduced-motion: no-preference) { html { scroll-behavior: smooth; } }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.6 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; }
.wide { max-width: 1200px; margin: 0 auto; padding: 0 20px; }
.skip { position: absolute; left: -999px; }
.skip:focus { left: 12px; top: 12px; background: var(--card); padding: 8px 14px; z-index: 5; }
header.wide { padding-top: 44px; padding-bottom: 8px; }
.brand { margin: 0; color: var(--soft); font-size: 14px; letter-spacing: .04em; }
h1 { font-size: clamp(26px, 5vw, 40px); line-height: 1.2; margin: 6px 0 12px; overflow-wrap: anywhere; font-weight: 650; }
h2 { font-size: 24px; margin: 0 0 12px; font-weight: 650; }
h3 { font-size: 18px; margin: 0 0 10px; font-weight: 600; }
.lead { font-size: 19px; max-width: 46em; margin: 0; }
nav ul { list-style: none; display: flex; flex-wrap: wrap; gap: 6px 20px; padding: 14px 0; margin: 18px 0 0; border-top: 1px solid var(--line);
  border-bottom: 1px solid var(--line); }
a { color: var(--accent); text-underline-offset: 3px; }
:focus-visible { outline: 3px solid var(--accent); outline-offset: 3px; border-radius: 3px; }
section { padding: 40px 0 0; }
p, li, dd { max-width: 46em; }
.scroll { overflow-x: auto; border: 1px solid var(--line); border-radius: 8px; background: var(--card); }
table { border-collapse: collapse; width: 100%; font-size: 14.5px; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding: 10px 14px 0; color: var(--soft); font-size: 14px; }
th, td { padding: 9px 11px; text-align: right; white-space: nowrap; border-top: 1px solid var(--line); }
thead th { border-top: 0; color: var(--soft); font-weight: 600; }
th:first-child, td.text, th.text { text-align: left; }
td.text { white-space: normal; overflow-wrap: anywhere; }
.level { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 18px; margin: 0 0 20px; }
.shots { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 250px), 1fr)); gap: 16px; }
figure { margin: 0; }
figcaption { color: var(--soft); font-size: 14px; margin-top: 6px; }
.zoom { display: block; position: relative; cursor: zoom-in; }
.zoom input { position: absolute; opacity: 0; width: 100%; height: 100%; margin: 0; cursor: inherit; }
.zoom img { display: block; width: 100%; height: auto; border-radius: 6px; background: #eceef1; }
.zoom input:focus-visible + img { outline: 3px solid var(--accent); outline-offset: 3px; }
@media screen { .zoom input:checked { z-index: 11; position: fixed; inset: 0; width: 100vw; height: 100vh; cursor: zoom-out; }
.zoom input:checked + img { position: fixed; inset: 0; width: 100vw; height: 100vh; object-fit: contain; z-index: 10; border-radius: 0;
  background: rgba(10, 12, 14, .92); } }
.none { display: grid; place-items: center; aspect-ratio: 4 / 3; border: 1px dashed var(--line); border-radius: 6px; color: var(--soft);
  font-size: 14px; padding: 16px; text-align: center; }
.legend { max-width: 420px; margin: 0 0 20px; font-size: 14px; color: var(--soft); }
.legend .bar { height: 14px; border-radius: 4px; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
.legend .ends { display: flex; justify-content: space-between; font-variant-numeric: tabular-nums; }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 460px), 1fr)); gap: 20px; }
.plots figure { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 14px; }
.plot { display: block; width: 100%; height: auto; font-size: 13px; }
.plot text { fill: var(--ink); } .plot .tick, .plot .label { fill: var(--soft); }
.plot .grid { stroke: var(--line); stroke-width: 1; } .plot .axis { stroke: var(--soft); fill: none; }
.plot g path { fill: none; stroke-width: 2; stroke: currentColor; } .plot g circle { fill: currentColor; } .plot g text { fill: currentColor; }
.line-0 { color: var(--c0); } .line-1 { color: var(--c1); } .line-2 { color: var(--c2); }
.line-3 { color: var(--c3); } .line-4 { color: var(--c4); } .line-5 { color: var(--c5); }
.warnings { background: var(--warn); border: 1px solid var(--line); border-radius: 8px; padding: 14px 14px 14px 34px; margin: 0; }
.warnings li { margin: 4px 0; overflow-wrap: anywhere; }
h3.more { margin-top: 22px; }
@media screen and (max-width: 560px) { .plot { font-size: 22px; } }
dt { font-weight: 600; margin-top: 12px; } dd { margin: 2px 0 0; }
footer { color: var(--soft); font-size: 14px; }
footer.wide { padding-top: 44px; padding-bottom: 36px; }
@media print { :root { color-scheme: light; --paper: #fff; --card: #fff; --ink: #000; --soft: #444; --line: #ccc; --accent: #000; --warn: #fff; }
  body { font-size: 11pt; } nav, .skip { display: none; } section { padding-top: 22px; }
  .level, .plots figure, tr, .warnings li { break-inside: avoid; } h2, h3 { break-after: avoid; }
  .shots { grid-template-columns: repeat(3, 1fr); } .scroll { overflow: visible; } table { font-size: 8pt; } th, td { padding: 3px 5px; white-space: normal; } }
)css";

}  // namespace lodestone::report::detail
