using System.IO;
using UnrealBuildTool;

// dance_adapter.h, DanceAdapter.hpp and libdance_adapter.so.1 of one version lie in ThirdParty: the
// installed bindings have them there. A packaged game gets the library at the same place in its
// plug-in's folder, where DanceLiveLinkSource.cpp looks for it.
public class DanceGraph : ModuleRules
{
    public DanceGraph(ReadOnlyTargetRules Target) : base(Target)
    {
        PCHUsage = PCHUsageMode.NoPCHs;
        CppStandard = CppStandardVersion.Cpp17;
        bEnableUndefinedIdentifierWarnings = false;
        string thirdParty = Path.Combine(ModuleDirectory, "ThirdParty");
        PublicIncludePaths.Add(thirdParty);
        RuntimeDependencies.Add(Path.Combine(thirdParty, "libdance_adapter.so.1"));
        PrivateDependencyModuleNames.AddRange(new string[]
        {
            "Core", "CoreUObject", "Engine", "LiveLinkInterface", "LiveLinkAnimationCore", "Projects",
        });
    }
}
