#include <CoreMinimal.h>
#include <DanceLiveLinkSource.h>
#include <Features/IModularFeatures.h>
#include <HAL/IConsoleManager.h>
#include <ILiveLinkClient.h>
#include <Modules/ModuleManager.h>

// The console command `dance.livelink [name of the house]` adds the house's dancers to Live Link.
class FDanceGraphModule : public IModuleInterface {
 public:
  virtual void StartupModule() override {
    Command = IConsoleManager::Get().RegisterConsoleCommand(
        TEXT("dance.livelink"),
        TEXT("Adds the dancers of a DanceGraph house to Live Link: dance.livelink [name]"),
        FConsoleCommandWithArgsDelegate::CreateStatic(&FDanceGraphModule::AddSource));
  }
  virtual void ShutdownModule() override {
    if (Command) IConsoleManager::Get().UnregisterConsoleObject(Command);
    Command = nullptr;
  }

 private:
  static void AddSource(const TArray<FString>& Arguments) {
    IModularFeatures& Features = IModularFeatures::Get();
    if (!Features.IsModularFeatureAvailable(ILiveLinkClient::ModularFeatureName)) return;
    ILiveLinkClient& Client =
        Features.GetModularFeature<ILiveLinkClient>(ILiveLinkClient::ModularFeatureName);
    const FString House = Arguments.Num() > 0 ? Arguments[0] : FString();
    Client.AddSource(MakeShared<FDanceLiveLinkSource>(House));
  }

  IConsoleObject* Command = nullptr;
};

IMPLEMENT_MODULE(FDanceGraphModule, DanceGraph)
