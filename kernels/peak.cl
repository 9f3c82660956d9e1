// What the device can do at most: the denominators of `moclean denoise --profile`.

// Twelve independent sums s <- s x + x per work-item, enough to hide the latency of a multiply-add.
// Launch: any number of work-items.
kernel void multiply_add(int rounds,
                         real x,               // below 1: the sums stay finite
                         global real* sink) {  // [work-items x VW], so that nothing is left out
  const vreal factor = x;
  vreal s0 = 0, s1 = 1, s2 = 2, s3 = 3, s4 = 4, s5 = 5, s6 = 6, s7 = 7, s8 = 8, s9 = 9, sa = 10,
        sb = 11;
  for (int i = 0; i < rounds; ++i) {
    s0 = fma(s0, factor, factor);
    s1 = fma(s1, factor, factor);
    s2 = fma(s2, factor, factor);
    s3 = fma(s3, factor, factor);
    s4 = fma(s4, factor, factor);
    s5 = fma(s5, factor, factor);
    s6 = fma(s6, factor, factor);
    s7 = fma(s7, factor, factor);
    s8 = fma(s8, factor, factor);
    s9 = fma(s9, factor, factor);
    sa = fma(sa, factor, factor);
    sb = fma(sb, factor, factor);
  }
  store(sink + get_global_id(0) * VW, s0 + s1 + s2 + s3 + s4 + s5 + s6 + s7 + s8 + s9 + sa + sb);
}

// target <- source. On a CPU (VW > 1) each work-item copies a stretch of its own; on a GPU
// neighbours copy neighbouring numbers.
// Launch: `items` work-items.
kernel void copy(int items,
                 long size,                  // reals, a multiple of items x VW
                 global const real* source,  // [size]
                 global real* target) {      // [size]
  const long item = get_global_id(0);
  const long begin = VW > 1 ? item * (size / items) : item;
  const long end = VW > 1 ? begin + size / items : size;
  const long step = VW > 1 ? VW : items;
  for (long i = begin; i < end; i += step) store(target + i, load(source + i));
}
