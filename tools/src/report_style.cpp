#include "paloc/tools/report_sections.h"

namespace paloc::report {

// Colours of the flags differ in lightness as well as in hue, and paths in their dashes: neither
// colour blindness nor print takes the meaning away.
std::string styleSheet() {
  return R"css(
:root { color-scheme: light dark; --page: #f5f7fa; --card: #fff; --ink: #17212e; --soft: #566373;
  --rule: #dbe2ea; --grid: #e3e9f0; --paper: #fbfcfe; --link: #1d4ed8; --code: #f0f3f8;
  --good: #0f766e; --degenerate: #c2700a; --coasting: #7c3aed; --lost: #d21f3c;
  --s1: #2563eb; --s2: #d97706; --s3: #0d9488; --total: #17212e; --halo: #fff;
  --map: none; }
@media (prefers-color-scheme: dark) { :root { --page: #0e141b; --card: #161e28; --ink: #e7edf4;
  --soft: #9fb0c2; --rule: #2a3644; --grid: #243040; --paper: #121a23; --link: #8ab4ff;
  --code: #0f1720; --good: #2dd4bf; --degenerate: #fbbf24; --coasting: #b79cff; --lost: #ff7085;
  --s1: #6ea8ff; --s2: #fbb04b; --s3: #3fd6c2; --total: #e7edf4; --halo: #0b1118;
  --map: brightness(2.3) saturate(.6); } }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; scroll-behavior: smooth; }
@media (prefers-reduced-motion: reduce) { html { scroll-behavior: auto; } }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
.page { max-width: 1120px; margin: 0 auto; padding: 28px 24px 56px; }
header .kind { margin: 0; color: var(--soft); font-size: .82rem; letter-spacing: .08em;
  text-transform: uppercase; }
h1 { margin: 2px 0 0; font-size: 1.9rem; line-height: 1.2; overflow-wrap: anywhere; }
header .facts { margin: 6px 0 0; color: var(--soft); font-size: .92rem; }
h2 { margin: 0 0 4px; font-size: 1.25rem; line-height: 1.3; }
h3 { margin: 0; font-size: 1rem; line-height: 1.35; }
h3 small { color: var(--soft); font-weight: 400; }
p { margin: 6px 0; max-width: 78ch; }
a { color: var(--link); }
:focus-visible { outline: 3px solid var(--link); outline-offset: 2px; border-radius: 4px; }
.lead { color: var(--soft); }
section { margin-top: 20px; padding: 22px 24px; background: var(--card); border: 1px solid var(--rule);
  border-radius: 14px; }
.verdict { border-left: 8px solid var(--tone); }
.verdict.good { --tone: var(--good); } .verdict.degraded { --tone: var(--degenerate); }
.verdict.none { --tone: var(--lost); }
.verdict h2 { display: flex; gap: 12px; align-items: center; font-size: 1.4rem; }
.verdict .badge { flex: none; width: 32px; height: 32px; border-radius: 50%; background: var(--tone);
  color: var(--card); font-size: 1.1rem; line-height: 32px; text-align: center; }
.verdict p { font-size: 1.05rem; max-width: 88ch; }
.verdict .caveat { color: var(--soft); font-size: .92rem; max-width: 100ch; }
nav { margin-top: 16px; font-size: .95rem; }
nav ul { display: flex; flex-wrap: wrap; gap: 4px 20px; margin: 0; padding: 0; list-style: none; }
nav a { display: inline-block; padding: 4px 0; text-decoration: none; }
nav a:hover { text-decoration: underline; }
.figures { display: grid; grid-template-columns: repeat(4, 1fr); gap: 12px; margin: 20px 0 0;
  padding: 0; }
.figures div { padding: 14px 16px; background: var(--card); border: 1px solid var(--rule);
  border-radius: 14px; }
.figures dt { color: var(--soft); font-size: .86rem; line-height: 1.35; }
.figures dd { margin: 2px 0 0; font-size: 1.5rem; font-weight: 650; line-height: 1.25;
  font-variant-numeric: tabular-nums; }
.figures dd.note { font-size: .86rem; font-weight: 400; color: var(--soft); }
figure { margin: 22px 0 0; }
figcaption { display: flex; flex-wrap: wrap; gap: 2px 20px; align-items: baseline; }
figcaption p { flex-basis: 100%; margin: 0; color: var(--soft); font-size: .9rem; max-width: none; }
.legend { display: flex; flex-wrap: wrap; gap: 2px 16px; margin: 0; padding: 0; list-style: none;
  font-size: .9rem; }
.legend.flags { margin-top: 12px; }
.swatch { display: inline-block; width: 22px; height: 4px; margin-right: 7px; border-radius: 2px;
  vertical-align: middle; background: currentColor; }
.swatch.total { height: 6px; opacity: .4; }
.swatch.dot { width: 9px; height: 9px; border-radius: 50%; }
.s1 { color: var(--s1); } .s2 { color: var(--s2); } .s3 { color: var(--s3); }
.total { color: var(--total); } .refused { color: var(--lost); }
.good { --flag: var(--good); } .degenerate { --flag: var(--degenerate); }
.coasting { --flag: var(--coasting); } .lost { --flag: var(--lost); }
.swatch.good, .swatch.degenerate, .swatch.coasting, .swatch.lost { color: var(--flag); }
.flag { display: inline-block; padding: 0 9px; border: 1.5px solid var(--flag); border-radius: 99px;
  font-size: .86rem; font-weight: 600; white-space: nowrap; }
svg { display: block; width: 100%; height: auto; margin-top: 6px; }
svg.narrow { display: none; }
svg text { fill: var(--soft); font-size: 12.5px; font-family: inherit;
  font-variant-numeric: tabular-nums; }
svg .unit { font-size: 13px; }
svg .marktext { fill: var(--ink); font-size: 14px; font-weight: 650; paint-order: stroke;
  stroke: var(--halo); stroke-width: 4px; stroke-linejoin: round; }
.grid { stroke: var(--grid); stroke-width: 1; } .axis { stroke: var(--soft); stroke-width: 1; }
.mapview .grid { stroke-opacity: .7; }
.line { fill: none; stroke: currentColor; stroke-width: 1.6; stroke-linejoin: round; }
.line.total { stroke-width: 5; stroke-opacity: .3; }
.dots { fill: none; stroke: currentColor; stroke-width: 4.5; stroke-linecap: round; }
.paper { fill: var(--paper); stroke: var(--rule); }
.map { opacity: .8; filter: var(--map); }
.halo { fill: none; stroke: var(--halo); stroke-width: 7; stroke-linejoin: round;
  stroke-linecap: round; stroke-opacity: .85; }
.way { fill: none; stroke: var(--flag); stroke-width: 3; stroke-linejoin: round;
  stroke-linecap: round; }
.way.degenerate { stroke-width: 4.5; } .way.coasting { stroke-width: 4.5; stroke-dasharray: 7 6; }
.way.lost { stroke-width: 4.5; stroke-dasharray: 1 7; }
.mark { fill: var(--ink); stroke: var(--halo); stroke-width: 2; }
.scalebar { fill: none; stroke: var(--ink); stroke-width: 2; }
.scalehalo { fill: none; stroke: var(--halo); stroke-width: 6; stroke-linecap: round; }
.band-good { fill: var(--good); } .band-degenerate { fill: var(--degenerate); }
.band-coasting { fill: var(--coasting); } .band-lost { fill: var(--lost); }
.shade-degenerate, .shade-coasting, .shade-lost { fill: var(--flag); fill-opacity: .17; }
.shade-degenerate { --flag: var(--degenerate); } .shade-coasting { --flag: var(--coasting); }
.shade-lost { --flag: var(--lost); }
.scroll { margin-top: 14px; overflow-x: auto; }
table { width: 100%; border-collapse: collapse; font-size: .93rem; font-variant-numeric: tabular-nums; }
caption { padding-bottom: 6px; color: var(--soft); font-size: .9rem; text-align: left; }
th, td { padding: 7px 18px 7px 0; border-bottom: 1px solid var(--rule); text-align: left;
  vertical-align: top; }
tbody tr:last-child th, tbody tr:last-child td { border-bottom: 0; }
th { font-weight: 600; } thead th { color: var(--soft); font-size: .86rem; white-space: nowrap; }
.number { text-align: right; white-space: nowrap; }
.bar { display: block; width: 150px; height: 6px; margin-top: 2px; background: var(--grid);
  border-radius: 5px; overflow: hidden; }
.bar span { display: block; height: 100%; background: var(--s1); }
.break { overflow-wrap: anywhere; }
pre { margin: 10px 0 0; padding: 14px 16px; overflow-x: auto; background: var(--code);
  border: 1px solid var(--rule); border-radius: 10px; font-size: .86rem; line-height: 1.5; }
pre.wrap { white-space: pre-wrap; overflow-wrap: anywhere; }
code, pre { font-family: ui-monospace, SFMono-Regular, Menlo, "DejaVu Sans Mono", monospace; }
details { margin-top: 14px; } summary { cursor: pointer; font-weight: 600; padding: 4px 0; }
.notes { margin: 8px 0 0; padding-left: 20px; } .notes li { margin: 4px 0; max-width: 78ch; }
footer { margin-top: 24px; color: var(--soft); font-size: .88rem; }
@media (max-width: 860px) { .figures { grid-template-columns: repeat(2, 1fr); } }
@media (max-width: 640px) { .page { padding: 16px 12px 40px; } h1 { font-size: 1.45rem; }
  section { padding: 16px 14px; } .verdict h2 { font-size: 1.2rem; } .figures dd { font-size: 1.25rem; }
  .figures div { padding: 12px; } svg.wide { display: none; } svg.narrow { display: block; }
  .mapview text { font-size: 22px; } .mapview .unit { font-size: 22px; } .mapview .marktext { font-size: 27px; }
  .mapview .way { stroke-width: 6; } .mapview .way.degenerate { stroke-width: 8; }
  .mapview .way.coasting { stroke-width: 8; stroke-dasharray: 12 11; }
  svg.narrow text { font-size: 12px; } }
@media print { body { background: #fff; } section, .figures div { break-inside: avoid; } nav { display: none; } }
)css";
}

}  // namespace paloc::report
