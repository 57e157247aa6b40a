// Pools that are larger than one storage block stand in LIST_BANKS blocks of 2^LIST_BANK_SHIFT nodes each.
// LIST_IN_BANK(USE, i) is USE(bank, index in it) for node i; with one bank it costs nothing.
#ifndef LIST_BANKS
#define LIST_BANKS 1
#endif
#if LIST_BANKS == 1
#define LIST_IN_BANK(USE, i) USE(0, i)
#else
#define LIST_BANK_MASK ((1u << LIST_BANK_SHIFT) - 1u)
#define LIST_IN_BANK(USE, i)                                                \
  if ((i) >> LIST_BANK_SHIFT == 0u) { USE(0, (i) & LIST_BANK_MASK); }       \
  else if ((i) >> LIST_BANK_SHIFT == 1u) { USE(1, (i) & LIST_BANK_MASK); }  \
  else if ((i) >> LIST_BANK_SHIFT == 2u) { USE(2, (i) & LIST_BANK_MASK); }  \
  else { USE(3, (i) & LIST_BANK_MASK); }
#endif
