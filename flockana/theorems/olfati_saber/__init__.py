"""The theorems of Olfati-Saber (2006) and what follows from them."""
