// Tables whose heads are buttons are sorted by what is pressed; rows are filtered by the beginning of their names.
const body = document.querySelector("table.sortable tbody");
const heads = [...document.querySelectorAll("table.sortable thead th")];

function value(row, column) {
  const cell = row.cells[column];
  return cell.dataset.value === undefined ? cell.textContent : Number(cell.dataset.value);
}

// numbers come before words, and before what is empty
function order(a, b) {
  if (typeof a !== typeof b) return typeof a === "number" ? -1 : 1;
  return typeof a === "number" ? a - b : a.localeCompare(b);
}

heads.forEach((head, column) => head.querySelector("button")?.addEventListener("click", () => {
  const falling = head.getAttribute("aria-sort") === "ascending";
  heads.forEach((each) => each.removeAttribute("aria-sort"));
  head.setAttribute("aria-sort", falling ? "descending" : "ascending");
  const rows = [...body.rows].sort((a, b) => order(value(a, column), value(b, column)));
  body.append(...(falling ? rows.reverse() : rows));
}));

document.getElementById("filter").addEventListener("input", (event) => {
  const words = event.target.value.toLowerCase().split(/[\s,]+/).filter(Boolean);
  for (const row of body.rows) {
    const name = row.dataset.name.toLowerCase();
    row.hidden = words.length > 0 && !words.some((word) => name.startsWith(word));
  }
});
