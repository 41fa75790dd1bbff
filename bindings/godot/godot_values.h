// Godot's values in C: what the plug-in's functions take from their arguments and give back.
//
// Units/frames: none.
// Ownership:    what is given to append_*() is copied; a list or an array of numbers that is made
//               here ends as the result of a call, by result_of_list().
// Threads:      Godot's main thread.
// Failure:      an argument that is missing is 0, "" or has no numbers; one of another type is
//               converted as Godot does.
#pragma once

#include <string.h>

#include "bindings/godot/godot3_api.h"

extern const godot_api* godot;

#define GODOT_CALL(place, type) ((type)godot->functions[place])

static inline int argument_count(const godot_array* arguments) {
  return GODOT_CALL(kArraySize, int (*)(const godot_array*))(arguments);
}

static inline godot_variant argument(const godot_array* arguments, int index) {
  if (index < argument_count(arguments))
    return GODOT_CALL(kArrayGet, godot_variant(*)(const godot_array*, int))(arguments, index);
  godot_variant none;
  GODOT_CALL(kVariantNewNil, void (*)(godot_variant*))(&none);
  return none;
}

static inline void destroy_variant(godot_variant* value) {
  GODOT_CALL(kVariantDestroy, void (*)(godot_variant*))(value);
}

static inline int64_t int_argument(const godot_array* arguments, int index) {
  godot_variant value = argument(arguments, index);
  const int64_t number = GODOT_CALL(kVariantAsInt, int64_t(*)(const godot_variant*))(&value);
  destroy_variant(&value);
  return number;
}

// Cut at the size of `text`, which a name that fits never needs.
static inline void text_argument(const godot_array* arguments, int index, char* text, int size) {
  text[0] = '\0';
  if (index >= argument_count(arguments)) return;
  godot_variant value = argument(arguments, index);
  godot_string string = GODOT_CALL(kVariantAsString, godot_string(*)(const godot_variant*))(&value);
  godot_char_string bytes =
      GODOT_CALL(kStringUtf8, godot_char_string(*)(const godot_string*))(&string);
  const int length = GODOT_CALL(kCharStringLength, int (*)(const godot_char_string*))(&bytes);
  const char* data = GODOT_CALL(kCharStringData, const char* (*)(const godot_char_string*))(&bytes);
  const int kept = length < size - 1 ? length : size - 1;
  memcpy(text, data, (size_t)kept);
  text[kept] = '\0';
  GODOT_CALL(kCharStringDestroy, void (*)(godot_char_string*))(&bytes);
  GODOT_CALL(kStringDestroy, void (*)(godot_string*))(&string);
  destroy_variant(&value);
}

// Whether there were at least `count` numbers.
static inline bool numbers_argument(const godot_array* arguments, int index, float* numbers,
                                    int count) {
  if (index >= argument_count(arguments)) return false;
  godot_variant value = argument(arguments, index);
  godot_pool_real_array array =
      GODOT_CALL(kVariantAsPoolReal, godot_pool_real_array(*)(const godot_variant*))(&value);
  const bool is_enough =
      GODOT_CALL(kPoolRealSize, int (*)(const godot_pool_real_array*))(&array) >= count;
  if (is_enough) {
    godot_pool_access* access =
        GODOT_CALL(kPoolRealRead, godot_pool_access * (*)(const godot_pool_real_array*))(&array);
    memcpy(numbers,
           GODOT_CALL(kPoolRealReadPointer, const float* (*)(const godot_pool_access*))(access),
           (size_t)count * sizeof(float));
    GODOT_CALL(kPoolRealReadDestroy, void (*)(godot_pool_access*))(access);
  }
  GODOT_CALL(kPoolRealDestroy, void (*)(godot_pool_real_array*))(&array);
  destroy_variant(&value);
  return is_enough;
}

static inline godot_array make_list(void) {
  godot_array list;
  GODOT_CALL(kArrayNew, void (*)(godot_array*))(&list);
  return list;
}

static inline void append_variant(godot_array* list, godot_variant* value) {
  GODOT_CALL(kArrayAppend, void (*)(godot_array*, const godot_variant*))(list, value);
  destroy_variant(value);
}

static inline godot_variant result_of_int(int64_t number) {
  godot_variant value;
  GODOT_CALL(kVariantNewInt, void (*)(godot_variant*, int64_t))(&value, number);
  return value;
}

static inline void append_int(godot_array* list, int64_t number) {
  godot_variant value = result_of_int(number);
  append_variant(list, &value);
}

static inline void append_real(godot_array* list, double number) {
  godot_variant value;
  GODOT_CALL(kVariantNewReal, void (*)(godot_variant*, double))(&value, number);
  append_variant(list, &value);
}

static inline godot_variant result_of_text(const char* text) {
  godot_string string = GODOT_CALL(kStringFromUtf8, godot_string(*)(const char*))(text);
  godot_variant value;
  GODOT_CALL(kVariantNewString, void (*)(godot_variant*, const godot_string*))(&value, &string);
  GODOT_CALL(kStringDestroy, void (*)(godot_string*))(&string);
  return value;
}

static inline void append_text(godot_array* list, const char* text) {
  godot_variant value = result_of_text(text);
  append_variant(list, &value);
}

static inline void append_numbers(godot_array* list, const float* numbers, int count) {
  godot_pool_real_array array;
  GODOT_CALL(kPoolRealNew, void (*)(godot_pool_real_array*))(&array);
  GODOT_CALL(kPoolRealResize, void (*)(godot_pool_real_array*, int))(&array, count);
  godot_pool_access* access =
      GODOT_CALL(kPoolRealWrite, godot_pool_access * (*)(godot_pool_real_array*))(&array);
  memcpy(GODOT_CALL(kPoolRealWritePointer, float* (*)(const godot_pool_access*))(access), numbers,
         (size_t)count * sizeof(float));
  GODOT_CALL(kPoolRealWriteDestroy, void (*)(godot_pool_access*))(access);
  godot_variant value;
  GODOT_CALL(kVariantNewPoolReal, void (*)(godot_variant*, const godot_pool_real_array*))
  (&value, &array);
  GODOT_CALL(kPoolRealDestroy, void (*)(godot_pool_real_array*))(&array);
  append_variant(list, &value);
}

static inline godot_variant result_of_list(godot_array* list) {
  godot_variant value;
  GODOT_CALL(kVariantNewArray, void (*)(godot_variant*, const godot_array*))(&value, list);
  GODOT_CALL(kArrayDestroy, void (*)(godot_array*))(list);
  return value;
}
