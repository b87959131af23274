// Search over SECTIONS: every word has to begin a word of a section; headings count more than text.
const query = document.getElementById("query"), found = document.getElementById("found");
const escaped = (text) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const begins = (word) => new RegExp(`(^|[^\\p{L}\\p{N}])${word.replace(/[.*+?^${"$"}{}()|[\]\\]/g, "\\$&")}`, "iu");
function score(section, words) {
  let sum = 0;
  for (const word of words) {
    const inHeading = word.test(section.heading), inText = word.test(section.text);
    if (!inHeading && !inText) return 0;
    sum += (inHeading ? 10 : 0) + (inText ? 1 : 0);
  }
  return sum;
}
function excerpt(text, word) {
  const at = Math.max(0, text.search(word) - 50);
  return (at ? "… " : "") + text.slice(at, at + 150) + (text.length > at + 150 ? " …" : "");
}
function show() {
  const words = query.value.trim().split(/\s+/).filter(Boolean).map(begins);
  const hits = words.length ? SECTIONS.map((s) => [score(s, words), s]).filter(([n]) => n) : [];
  hits.sort((a, b) => b[0] - a[0]);
  found.hidden = !words.length;
  found.innerHTML = hits.slice(0, 12).map(([, s]) => `<li><a href="${s.url}"><b>${escaped(s.heading)}</b> · ` +
    `${escaped(s.page)}<span>${escaped(excerpt(s.text, words[0]))}</span></a></li>`).join("") || "<li>nothing found</li>";
}
query.addEventListener("input", show);
query.addEventListener("keydown", (e) => { if (e.key === "Enter") { const a = found.querySelector("a"); if (a) a.click(); } });
document.addEventListener("keydown", (e) => {
  if (e.key === "/" && document.activeElement !== query) { e.preventDefault(); query.focus(); }
  if (e.key === "Escape") { query.value = ""; show(); }
});
document.addEventListener("click", (e) => { if (!e.target.closest(".search")) found.hidden = true; else if (query.value) show(); });
if (matchMedia("(max-width: 46rem)").matches) document.querySelector("nav details").open = false;
