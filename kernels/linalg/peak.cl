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
// neighbours copy neighbouring numbers, four loads in flight at a time.
// Launch: `items` work-items.
kernel void copy(int items,
                 long size,                  // reals; VW > 1: a multiple of items x VW
                 global const real* source,  // [size]
                 global real* target) {      // [size]
  const long item = get_global_id(0);
#if VW > 1
  const long begin = item * (size / items), end = begin + size / items;
  for (long i = begin; i < end; i += VW) store(target + i, load(source + i));
#else
  const long step = items;
  long i = item;
  for (; i + 3 * step < size; i += 4 * step) {
    const real v0 = source[i], v1 = source[i + step];
    const real v2 = source[i + 2 * step], v3 = source[i + 3 * step];
    target[i] = v0;
    target[i + step] = v1;
    target[i + 2 * step] = v2;
    target[i + 3 * step] = v3;
  }
  for (; i < size; i += step) target[i] = source[i];
#endif
}
