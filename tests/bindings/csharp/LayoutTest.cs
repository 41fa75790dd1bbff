// The structs of DanceAdapter.cs lie in memory as the C compiler says (layout.c, on the standard input),
// none of their fields is left out, and the library is found by the name that its package gives it.
using System;
using System.Collections.Generic;
using System.Reflection;
using System.Runtime.InteropServices;
using DanceGraph;

public static class LayoutTest
{
    // music_beats is MusicBeats in C#.
    private static string InCSharp(string field)
    {
        string name = "";
        foreach (string word in field.Split('_')) name += char.ToUpperInvariant(word[0]) + word.Substring(1);
        return name;
    }

    public static int Main()
    {
        int failures = 0, checks = 0;
        var seen = new Dictionary<Type, int>();
        for (string line = Console.ReadLine(); line != null; line = Console.ReadLine())
        {
            string[] words = line.Split(' ');
            Type type = typeof(DanceNative).Assembly.GetType("DanceGraph." + words[0], true);
            int wanted = int.Parse(words[2]), got;
            if (words[1] == "-")
            {
                got = Marshal.SizeOf(type);
                seen[type] = 0;
            }
            else
            {
                got = (int)Marshal.OffsetOf(type, InCSharp(words[1]));
                ++seen[type];
            }
            ++checks;
            if (got == wanted) continue;
            ++failures;
            Console.WriteLine("FAILED: " + words[0] + " " + words[1] + " is at " + got + " and in C at " + wanted);
        }
        foreach (KeyValuePair<Type, int> one in seen)
        {
            int fields = one.Key.GetFields(BindingFlags.Instance | BindingFlags.Public).Length;
            if (fields == one.Value) continue;
            ++failures;
            Console.WriteLine("FAILED: " + one.Key.Name + " has " + fields + " fields and in C " + one.Value);
        }
        if (seen.Count != 7) ++failures;
        DanceNative.Check();
        Console.WriteLine((failures == 0 ? "passed: " : "FAILED: ") + checks + " sizes and offsets are those of C");
        return failures == 0 ? 0 : 1;
    }
}
