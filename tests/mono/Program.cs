using System;
using System.Reflection;
using System.Runtime.InteropServices;

namespace Brume.Tests
{
    internal static class Program
    {
        /// <summary>facts | functions | match FILE | calls FILE</summary>
        private static int Main(string[] arguments)
        {
            try
            {
                switch (arguments[0])
                {
                    case "facts": Facts.Print(); break;
                    case "functions": PrintFunctions(); break;
                    case "match": new Match(arguments[1]).Print(); break;
                    default: CallTests.Run(new Match(arguments[1])); break;
                }
                return 0;
            }
            catch (Exception error)
            {
                Console.Error.WriteLine(error);
                return 1;
            }
        }

        /// <summary>The functions of the library that are declared; Prelink finds each of them in it.</summary>
        private static void PrintFunctions()
        {
            foreach (MethodInfo method in typeof(Native).GetMethods(BindingFlags.Public | BindingFlags.Static))
            {
                if (!method.Name.StartsWith("brume_")) continue;
                Marshal.Prelink(method);
                Console.WriteLine(method.Name);
            }
        }
    }
}
