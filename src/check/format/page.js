const search = document.getElementById("search");
const boxes = [...document.querySelectorAll(".filters input[type=checkbox]")];
const cards = [...document.querySelectorAll("main .card")];
function filter() {
  const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
  const levels = new Set(boxes.filter(box => box.checked).map(box => box.value));
  let count = 0;
  for (const card of cards) {
    const found = words.every(word => card.dataset.words.includes(word));
    card.hidden = !(found && levels.has(card.dataset.worst));
    for (const item of card.querySelectorAll("li")) item.hidden = !levels.has(item.className);
    if (!card.hidden) count += 1;
  }
  document.getElementById("count").textContent = count + " of " + cards.length + " models";
}
search.addEventListener("input", filter);
boxes.forEach(box => box.addEventListener("change", filter));
document.querySelectorAll("[data-code]").forEach(link => link.addEventListener("click", event => {
  event.preventDefault();
  search.value = link.dataset.code;
  boxes.forEach(box => { box.checked = true; });
  filter();
}));
filter();
