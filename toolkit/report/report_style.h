#pragma once

namespace mimetra {

/// How a report looks: system fonts on white, as wide as the window up to a limit.
constexpr const char* kReportStyle = R"css(
:root { --ink: #1c1f24; --soft: #5b626d; --line: #dfe2e6; --accent: #0072b2; }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; max-width: 1180px; padding: 1.5rem 1.25rem 2.5rem; color: var(--ink);
  background: #fff; font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; }
h1 { margin: 0; font-size: 1.6rem; line-height: 1.25; font-weight: 650; overflow-wrap: anywhere; }
h2 { margin: 0 0 .35rem; font-size: 1.15rem; font-weight: 650; }
p { margin: 0 0 .9rem; max-width: 46rem; }
.soft, figcaption { color: var(--soft); }
section { margin-top: 2rem; }
dl.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(8.5rem, 1fr));
  gap: .6rem 1.25rem; margin: .9rem 0 0; padding: .7rem 0; border: solid var(--line);
  border-width: 1px 0; }
dl.facts dt { color: var(--soft); font-size: .82rem; }
dl.facts dd { margin: 0; font-size: 1.12rem; font-variant-numeric: tabular-nums;
  overflow-wrap: anywhere; }
.names { display: flex; align-items: end; font-size: .9rem; color: var(--soft); }
.names span { flex: 1 1 0; min-width: 0; padding: 0 .5rem; text-align: center;
  overflow-wrap: anywhere; }
#stage { position: relative; height: clamp(16rem, 54vh, 34rem); border: 1px solid var(--line);
  border-radius: .5rem; overflow: hidden; cursor: grab; }
#stage > div { position: absolute; inset: 0; outline: none; }
#stage canvas { display: block; width: 100%; height: 100%; }
.controls { display: flex; flex-wrap: wrap; align-items: center; gap: .6rem .9rem;
  margin: .7rem 0 .4rem; font-size: .95rem; }
.controls .timeline { display: flex; flex: 1 1 16rem; align-items: center; gap: .7rem; }
.controls input { flex: 1 1 auto; min-width: 0; height: 2rem; margin: 0; accent-color: var(--accent); }
.controls output { min-width: 4.2rem; text-align: right; font-variant-numeric: tabular-nums; }
button, select { min-height: 2.4rem; padding: .25rem .7rem; border: 1px solid #c3c8cf;
  border-radius: .4rem; background: #fff; color: inherit; font: inherit; }
button { cursor: pointer; }
#play { min-width: 5rem; border-color: var(--accent); background: var(--accent); color: #fff; }
button:hover, select:hover { border-color: var(--ink); }
:focus-visible { outline: 3px solid #56b4e9; outline-offset: 1px; }
#scale { display: flex; align-items: center; gap: .5rem; font-size: .9rem; color: var(--soft); }
#scale[hidden] { display: none; }
#scale i { width: 9rem; height: .75rem; border-radius: .2rem; }
#legend { display: flex; flex-wrap: wrap; gap: .3rem .8rem; font-size: .9rem; color: var(--soft); }
#legend[hidden], #legend span[hidden] { display: none; }
#legend i { display: inline-block; width: .9rem; height: .9rem; margin-right: .3rem; border-radius: .2rem;
  vertical-align: -.1rem; }
#picked { color: var(--ink); }
figure { margin: 0; }
img { display: block; width: 100%; height: auto; }
.strip img { max-width: 1180px; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 24rem), 1fr));
  gap: 1rem 1.5rem; }
table { width: 100%; border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .35rem .5rem; border-bottom: 1px solid var(--line); text-align: right;
  vertical-align: bottom; }
th { font-size: .82rem; font-weight: 500; line-height: 1.3; color: var(--soft); }
td { white-space: nowrap; }
th:first-child, td:first-child { padding-left: 0; text-align: left; }
th:last-child, td:last-child { padding-right: 0; }
tr.main td { font-weight: 650; }
.rows { margin-bottom: 1.25rem; }
pre { margin: 0 0 .9rem; padding: .7rem .9rem; border-radius: .4rem; background: #f4f5f7;
  font: .88rem/1.5 ui-monospace, Menlo, Consolas, monospace; white-space: pre-wrap;
  overflow-wrap: anywhere; }
ul { margin: 0 0 .9rem; padding-left: 1.2rem; }
li { overflow-wrap: anywhere; }
summary { cursor: pointer; color: var(--accent); }
details table { max-width: 36rem; margin-top: .5rem; }
@media (max-width: 700px) {
  body { padding: 1rem 1rem 2rem; }
  h1 { font-size: 1.3rem; }
  dl.facts { grid-template-columns: repeat(2, 1fr); }
  #stage { height: 19rem; }
  .controls .timeline { flex-basis: 100%; order: -2; }
  .controls button { flex: 1 1 40%; order: -1; }
  .controls label { flex: 1 1 40%; min-width: 0; }
  .controls label select { width: 100%; }
  th, td { padding: .35rem .2rem; font-size: .85rem; }
  th { font-size: .72rem; }
}
)css";

}  // namespace mimetra
