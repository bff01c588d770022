// Tables whose heads are buttons are sorted by what is pressed; rows are filtered by the beginning of their names.
const body = document.querySelector("table.sortable tbody");
const heads = [...document.querySelectorAll("table.sortable thead tr > *")];
const words = new Intl.Collator("en", { numeric: true });

function value(row, column) {
  const cell = row.cells[column];
  return cell.dataset.value === undefined ? cell.textContent : Number(cell.dataset.value);
}

// what is empty comes last, whichever way
function order(a, b, sign) {
  if (a === "" || b === "") return (a === "") - (b === "");
  return sign * (typeof a === "number" ? a - b : words.compare(a, b));
}

heads.forEach((head, column) => head.querySelector("button")?.addEventListener("click", () => {
  const falling = head.getAttribute("aria-sort") === "ascending";
  heads.forEach((each) => each.removeAttribute("aria-sort"));
  head.setAttribute("aria-sort", falling ? "descending" : "ascending");
  body.append(...[...body.rows].sort((a, b) => order(value(a, column), value(b, column), falling ? -1 : 1)));
}));

document.getElementById("filter").addEventListener("input", (event) => {
  const wanted = event.target.value.toLowerCase().split(/[\s,]+/).filter(Boolean);
  for (const row of body.rows) {
    const name = row.dataset.name.toLowerCase();
    row.hidden = wanted.length > 0 && !wanted.some((word) => name.startsWith(word));
  }
});
