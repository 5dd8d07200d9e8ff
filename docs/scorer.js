// Results of a search: pages of theorems first, then how-tos and names, then lectures.
var Scorer = {
  score: (result) => {
    const [page, , , , score] = result;
    const first = [["generated/theorems/", 30], ["howto/", 15], ["start", 15], ["generated/reference/", 5], ["generated/lectures/", -5]];
    const found = first.find(([start]) => page.startsWith(start));
    return score + (found ? found[1] : 0);
  },
  objNameMatch: 11, objPartialMatch: 6, objPrio: { 0: 15, 1: 5, 2: -5 }, objPrioDefault: 0,
  title: 15, partialTitle: 7, term: 5, partialTerm: 2,
};
